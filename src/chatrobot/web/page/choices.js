/** The answers that a question itself offers: "To the left or to the right?" has two. */

const MOST_WORDS = 4;
const MOST_CHARS = 24;

/** Return what can be answered, word for word; empty where a question offers nothing, or more than words. */
export function choicesOf(reply) {
  const question = reply.match(/[^.。!！?？]*[?？]\s*$/);
  if (!question) return [];
  const text = question[0].trim().replace(/[?？]$/, "");
  const offered = text.replace(/^.*[:：]/, "");
  if (!/ or |还是/.test(offered)) return [];
  const parts = offered.split(/,? or |,\s*|还是|、/).map((part) => part.trim().replace(/^(to the) /i, ""));
  const isShort = (part) => part && part.length <= MOST_CHARS && part.split(/\s+/).length <= MOST_WORDS;
  return parts.length > 1 && parts.every(isShort) ? parts : [];
}
