/** The box in which a person says something, with what was said before under the arrow keys. */

import { on, send, state } from "./connection.js";
import { byId, keepInTab, makeButton, takeFromTab } from "./dom.js";
import { placeName } from "./places.js";
import { notice } from "./steering.js";
import { onLanguage, t } from "./words.js";

const MOST_KEPT = 100;
const MOST_CHARS = 4000; // of one message, by the protocol
const KEPT = "chatrobot-said";

const box = byId("say");
const kept = [];
let at = 0;
let unsent = "";

/** Put a text into the box for a person to send or to change. */
export function fillBox(text) {
  box.value = text;
  at = kept.length;
}

/** Send what is in the box. It stays there where the connection is gone, and where another page steers: a stop counts. */
export function sendBox() {
  const text = box.value.trim();
  if (text.length > MOST_CHARS) notice(t("say_too_long", { count: text.length, most: MOST_CHARS }));
  if (!text || text.length > MOST_CHARS || !send({ do: "say", text })) return;
  if (!state.steers) {
    box.select();
    return;
  }
  keep(text);
  box.value = "";
  byId("examples").hidden = true;
}

/** What this page's person said before a reconnection can be had again, too. */
export function showHistory(message) {
  byId("examples").hidden = true;
  if (state.isReplaying && state.mine.has(String(message.by))) keep(message.text);
}

function keep(text) {
  if (kept[kept.length - 1] !== text) kept.push(text);
  if (kept.length > MOST_KEPT) kept.shift();
  at = kept.length;
}

function step(by) {
  if (at === kept.length) unsent = box.value;
  at = Math.max(0, Math.min(kept.length, at + by));
  box.value = at === kept.length ? unsent : kept[at];
  box.setSelectionRange(box.value.length, box.value.length);
}

/** What is half typed, and what was said before, outlive a reload. */
function keepOverReload() {
  const before = JSON.parse(takeFromTab(KEPT) || '{"draft": "", "kept": []}');
  before.kept.forEach(keep);
  fillBox(before.draft);
  addEventListener("pagehide", () => keepInTab(KEPT, JSON.stringify({ draft: box.value, kept })));
}

function showExamples() {
  const place = state.hello && state.hello.world.places[0];
  const texts = [t("example_forward"), t("example_turn"), t("example_square")];
  if (place) texts.push(t("example_place", { place: placeName(place) }));
  const buttons = texts.map((text) => makeButton(text, "small", () => {
    fillBox(text);
    sendBox();
    box.focus();
  }));
  byId("example-buttons").replaceChildren(...buttons);
}

export function startSayBox() {
  keepOverReload();
  byId("say-form").addEventListener("submit", (event) => {
    event.preventDefault();
    sendBox();
    box.focus(); // what is typed next is text, and drives nothing
  });
  box.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && !event.isComposing && !state.steers) {
      event.preventDefault(); // the disabled button would keep it from being sent
      sendBox();
      return;
    }
    if (event.isComposing || (event.key !== "ArrowUp" && event.key !== "ArrowDown") || !kept.length) return;
    event.preventDefault();
    step(event.key === "ArrowUp" ? -1 : 1);
  });
  on("open", () => {
    byId("examples").hidden = state.hello.history.some((message) => message.is === "said");
    showExamples();
  });
  onLanguage(showExamples);
}
