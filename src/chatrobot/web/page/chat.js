/** The chat: one entry a turn, which grows as the turn does; questions have buttons. */

import { choicesOf } from "./choices.js";
import { BEGUN_ANEW, on, send, state } from "./connection.js";
import { byId, make, makeButton, setText, takeFromTab } from "./dom.js";
import { showHistory } from "./say_box.js";
import { speak } from "./speech.js";
import { decimal, language, t } from "./words.js";

const MOST_ENTRIES = 300;
const NEAR_END_PX = 80;
const MARKS = { completed: "✓", answered: "", stopped: "■", refused: "!", unclear: "?", failed: "✕" };

const log = byId("talk");
const list = byId("turns");
const newest = byId("newest");
const entries = new Map();
let asking = null;
let isAtEnd = true;
let editPlan = () => {};

/** Where "Edit" leads: the plan's own panel. */
export function onEditPlan(listener) {
  editPlan = listener;
}

/** What belongs to no turn (0) has an entry of its own each time. */
function entryOf(turn) {
  let entry = turn ? entries.get(turn) : null;
  if (!entry) {
    entry = { turn, you: make("p", "you") };
    entry.you.hidden = true;
    addItem(entry);
    entry.item.prepend(entry.you);
    entries.set(turn, entry);
    forgetOldest();
  }
  return entry;
}

/** What the robot says of a turn, at the end of the list. */
function addItem(entry) {
  Object.assign(entry, {
    item: make("li", "turn"),
    robot: make("div", "robot"),
    text: make("p", "text"),
    found: make("ul", "found"),
    bar: make("span", "bar"),
    buttons: make("div", "buttons"),
  });
  entry.bar.hidden = entry.robot.hidden = true;
  entry.bar.setAttribute("aria-hidden", "true");
  entry.robot.append(entry.text, entry.found, entry.bar, entry.buttons);
  entry.item.append(entry.robot);
  list.append(entry.item);
}

/** How a turn ended is told below what was said meanwhile: what it was to do stays where it was. */
function goOnBelow(entry) {
  const isLast = entry.item === list.lastElementChild;
  if (isLast || entry.robot.hidden || !entry.text.textContent) return;
  forgetRehearsal(entry);
  addItem(entry);
}

function forgetOldest() {
  while (list.children.length > MOST_ENTRIES) {
    const oldest = list.firstElementChild;
    for (const [turn, entry] of entries) if (entry.item === oldest) entries.delete(turn);
    oldest.remove();
  }
}

function forgetAll() {
  entries.clear();
  list.replaceChildren();
  asking = null;
  markAsking();
}

/** Do `act` and keep the newest in sight; where a person has scrolled up to read, a button leads to what is new. */
function change(act, isNew = true) {
  act();
  if (isAtEnd || state.isReplaying) showEnd();
  else if (isNew) newest.hidden = false;
}

function showEnd() {
  isAtEnd = newest.hidden = true;
  log.scrollTop = log.scrollHeight;
}

function say(entry, text, outcome = "") {
  entry.robot.hidden = false;
  entry.robot.dataset.outcome = outcome;
  setText(entry.text, text);
  if (MARKS[outcome]) entry.text.prepend(make("span", "mark", MARKS[outcome]));
}

/** Put buttons under an entry; those of an earlier question go away. */
function ask(entry, buttons) {
  if (asking && asking !== entry) asking.buttons.replaceChildren();
  asking = entry;
  entry.buttons.replaceChildren(...buttons);
  markAsking();
}

/** Where another panel is seen, its tab says that something waits for an answer; a lesson makes room for the question. */
function markAsking() {
  document.body.classList.toggle("asks", asking !== null);
}

function unask(entry) {
  entry.buttons.replaceChildren();
  if (asking === entry) asking = null;
  markAsking();
}

function answer(entry, message) {
  return () => {
    if (send(message) && state.steers) unask(entry); // of who only watches it is refused, and the question stays
    byId("say").focus();
  };
}

function askApproval(entry) {
  const edit = () => editPlan(entry.turn);
  ask(entry, [
    makeButton(t("do_it"), "small main", answer(entry, { do: "approve", turn: entry.turn, yes: true })),
    makeButton(t("edit"), "small", edit),
    makeButton(t("cancel"), "small", answer(entry, { do: "approve", turn: entry.turn, yes: false })),
  ]);
}

function sayButton(entry, label, text, className) {
  return makeButton(label, className, answer(entry, { do: "say", text }));
}

const heard = {
  ordered(entry, event, text) {
    entry.you.hidden = false;
    entry.you.replaceChildren(make("span", "who", text), event.plan_text || event.program);
  },
  interpreted(entry, event) {
    if (event.reply) say(entry, event.reply, "understood");
  },
  rehearsed(entry, event, text) {
    const texts = [].concat(text || []);
    forgetRehearsal(entry);
    const severity = (at) => (event.findings[at] || {}).severity || "note";
    entry.found.append(...texts.map((one, at) => make("li", `rehearsal ${severity(at)}`, one)));
    if (event.ok && event.duration_s > 0) {
      const figures = { length: decimal(event.length_m, 2), duration: decimal(event.duration_s, 0) };
      entry.found.prepend(make("li", "rehearsal note", t(event.open_ended ? "rehearsed_open" : "rehearsed", figures)));
    }
    entry.robot.hidden = false;
    if (event.needs_approval) askApproval(entry);
  },
  started(entry) {
    unask(entry);
    entry.isStarted = true;
    entry.robot.hidden = entry.bar.hidden = false;
  },
  progress(entry, event) {
    entry.bar.hidden = false;
    entry.bar.classList.toggle("open", event.fraction === null);
    entry.bar.style.setProperty("--share", event.fraction ?? 1);
  },
  paused(entry, event, text) {
    say(entry, text || t("paused"), "paused");
    ask(entry, [makeButton(t("resume"), "small main", answer(entry, { do: "resume" }))]);
  },
  said(entry, event) {
    note(entry, event.text);
    if (!state.isReplaying) speak(event.text, language());
  },
  remembered(entry, event, text) {
    note(entry, text || event.place);
  },
  notice(entry, event, text) {
    note(entry, text || event.text);
  },
  result(entry, event, text) {
    unask(entry);
    entry.bar.hidden = true;
    if (event.reason?.code === "replaced" && !entry.isStarted) {
      forgetRehearsal(entry);
      say(entry, t("replaced"), "understood"); // nothing was stopped, so there is nothing to warn of
      return;
    }
    if (text) goOnBelow(entry);
    if (text) say(entry, text, event.outcome);
    forgetRehearsal(entry);
    if (event.proposal) {
      const yes = sayButton(entry, t("yes"), t("say_yes"), "small main");
      ask(entry, [yes, sayButton(entry, t("no"), t("say_no"), "small")]);
    } else if (event.outcome === "unclear") {
      const choices = choicesOf(text);
      if (choices.length) ask(entry, choices.map((one) => sayButton(entry, one, one, "small")));
    }
    if (!state.isReplaying && text) speak(text, language());
  },
};

/** The turn of an agent has no result here: its own session has that. */
heard.finished = heard.result;

function note(entry, text) {
  if (!text) return;
  entry.robot.hidden = false;
  entry.found.append(make("li", "note", text));
}

/** What was rehearsed is told by what came of it. */
function forgetRehearsal(entry) {
  for (const item of entry.found.querySelectorAll(".rehearsal")) item.remove();
}

function noteLine(text, kind = "line") {
  change(() => list.append(make("li", kind, text)));
}

function showSaid(message, isMine) {
  const entry = entryOf(message.turn);
  if (asking) unask(asking);
  entry.you.hidden = false;
  const who = isMine || !message.name ? [] : [make("span", "who", message.name)];
  entry.you.replaceChildren(...who, message.text);
  showHistory(message);
}

/** A lesson that comes up above, the keyboard of a phone, or a phone that is turned, does not hide the newest. */
function keepEndInSight() {
  let height = 0;
  log.addEventListener("scroll", () => {
    if (log.clientHeight !== height) return; // nobody has scrolled: there is less room now
    isAtEnd = log.scrollHeight - log.scrollTop - log.clientHeight < NEAR_END_PX;
    if (isAtEnd) newest.hidden = true;
  });
  new ResizeObserver(() => {
    height = log.clientHeight;
    if (isAtEnd) showEnd();
  }).observe(log);
}

/** Begin: hear what there is to show. */
export function startChat() {
  const isAnew = Boolean(takeFromTab(BEGUN_ANEW));
  on("open", () => {
    forgetAll();
    if (isAnew) noteLine(t("begun_anew"));
  });
  on("history", forgetAll);
  on("closed", () => {
    for (const entry of entries.values()) entry.bar.hidden = true; // what becomes of it is not known here
  });
  on("said", (message) => {
    const isMine = state.mine.has(String(message.by));
    if (isMine) isAtEnd = true; // what one has just said, and the answer, are what one wants to see
    change(() => showSaid(message, isMine));
  });
  on("event", (message) => {
    const event = message.event;
    const hear = heard[event.event];
    if (!hear) return;
    if (event.event === "notice" && !event.turn) noteLine([].concat(message.text || event.text).join(" "));
    else change(() => hear(entryOf(event.turn), event, message.text), event.event !== "progress");
  });
  on("lost", (message) => noteLine(message.text));
  on("note", (message) => noteLine(message.text));
  on("verdict", (message) => {
    noteLine(`${message.state === "passed" ? "✓" : "→"} ${message.text}`);
    if (!state.isReplaying) speak(message.text, language());
  });
  keepEndInSight();
  newest.addEventListener("click", () => {
    showEnd();
    log.focus();
  });
  on("task", (message) => noteLine(`${message.title}: ${message.text}`, "task"));
}
