/** The teacher's page: all robots of a class; stop one or all, release, look in, hand out a task and the links. */

import { connect, on, send } from "./connection.js";
import { byId, make, makeButton, restButton, setBanner, setChanging, setText, startMenus } from "./dom.js";
import { showRecordings, startRecordings } from "./recordings.js";
import { onStop } from "./stop.js";
import { decimal, firstLanguage, language, onLanguage, setLanguage, startLanguageMenu, t } from "./words.js";

const NOTICE_MS = 6000;
const BY_HAND_MS = 60000;
const SAID_MS = 2500;
const REALLY_MS = 4000;

const list = byId("robots");
const cards = new Map();
let robots = [];
let lesson = null;
let chosen = 2;
let noticeTimer = 0;
let saidTimer = 0;

function notice(text, forMs = NOTICE_MS) {
  clearTimeout(noticeTimer);
  setBanner(byId("notice-banner"), text);
  byId("notice-banner").classList.toggle("by-hand", forMs === BY_HAND_MS);
  if (text) noticeTimer = setTimeout(() => notice(""), forMs);
}

/** Copy a text; false where it cannot be. A page that is not secure, as those of most classes, has the old way alone. */
async function copy(text) {
  if (await navigator.clipboard?.writeText(text).then(() => true, () => false)) return true;
  const focused = document.activeElement;
  const field = make("textarea", "hidden", text);
  document.body.append(field);
  field.select();
  const isCopied = document.execCommand("copy");
  field.remove();
  focused?.focus();
  return isCopied;
}

async function copyLink(robot) {
  const link = new URL(robot.link, location.href).href;
  if (await copy(link)) notice(t("link_copied", { name: robot.name }));
  else notice(t("link_copied_by_hand", { link }), BY_HAND_MS);
}

/** A link ends at the second press: a class goes on while a teacher's finger slips. */
function endLink(card, robot) {
  clearTimeout(card.timer);
  const isMeant = card.item.classList.toggle("asked");
  if (isMeant) card.timer = setTimeout(() => card.item.classList.contains("asked") && endLink(card, null), REALLY_MS);
  else if (robot && send({ do: "revoke", room: robot.name })) notice(t("link_ended", { name: robot.name }));
  draw();
}

function makeCard(robot) {
  const room = robot.name;
  const card = {
    item: make("li", "panel seat"),
    title: make("h2"),
    state: make("span", "chip"),
    where: make("p", "where"),
    who: make("p", "who"),
    lesson: make("p", "lesson"),
    heard: make("p", "heard"),
    doing: make("p", "doing"),
    said: make("div", "said"),
    stop: makeButton("", "small stop-one", () => send({ do: "stop", room })),
    release: makeButton("", "small", () => send({ do: "release", room })),
    link: makeButton("", "small", () => copyLink(robots.find((one) => one.name === room))),
    end: makeButton("", "small", () => endLink(card, robots.find((one) => one.name === room))),
    open: make("a"),
    timer: 0,
  };
  card.open.href = `./?room=${encodeURIComponent(room)}`;
  card.open.target = "_blank";
  card.open.rel = "noopener";
  const head = make("header", "", card.title, card.state);
  const buttons = make("div", "buttons", card.stop, card.open, card.link, card.end);
  card.said.append(card.release, card.lesson, card.heard, card.doing);
  card.said.setAttribute("role", "group");
  card.item.append(head, buttons, card.who, card.where, card.said); // what comes and goes moves no button
  list.append(card.item);
  cards.set(room, card);
  return card;
}

function label(button, text, name) {
  setText(button, text);
  button.setAttribute("aria-label", `${text}: ${name}`);
}

function stateOf(robot) {
  if (robot.gone) return "state_unknown";
  if (robot.emergency) return "state_emergency";
  return robot.moving ? "state_moving" : "state_standing";
}

function drawCard(robot) {
  const card = cards.get(robot.name) || makeCard(robot);
  const name = t("pupil", { name: robot.name });
  setText(card.title, name);
  setText(card.state, t(stateOf(robot)));
  card.state.dataset.state = stateOf(robot);
  const who = robot.pages ? t("pages", { count: robot.pages }) : t("pages_none");
  setText(card.who, robot.is_looked_at ? `${who} · ${t("teacher_looks")}` : who);
  const [x, y, yaw] = robot.pose || [0, 0, 0];
  const heading = Math.round((Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180) / Math.PI) || 0;
  setText(card.where, robot.pose ? t("pose", { x: decimal(x, 2), y: decimal(y, 2), heading }) : "");
  drawTask(card.lesson, robot.lesson);
  setText(card.heard, robot.said);
  setText(card.doing, robot.plan_text || robot.reply);
  card.doing.dataset.outcome = robot.plan_text ? "" : robot.outcome;
  label(card.stop, t("stop"), name);
  label(card.release, t("release"), name);
  label(card.link, t("link_copy"), name);
  label(card.end, t(card.item.classList.contains("asked") ? "link_end_really" : "link_end"), name);
  setChanging(card.end, card.end.textContent, t("link_end_really"));
  card.said.setAttribute("aria-label", name);
  label(card.open, t("robot_open"), name);
  card.release.hidden = !robot.emergency;
}

/** Where a pupil is in the lesson, and what the last turn achieved. */
function drawTask(line, at) {
  line.hidden = !at;
  if (!at || !lesson) return;
  const passed = at.states.filter((one) => one === "passed").length;
  const values = { number: at.number, count: at.states.length, title: at.title, passed };
  const where = t(at.title ? "lesson_at" : "lesson_done", values);
  setText(line, at.verdict ? `${where} ${at.verdict}` : where);
  line.dataset.state = at.title ? at.verdict_state : "passed";
}

function drawLesson() {
  byId("lesson-form").hidden = !lesson;
  if (!lesson) return;
  setText(byId("lesson-title"), lesson.title);
  const done = robots.filter((robot) => robot.lesson && robot.lesson.states.every((one) => one === "passed")).length;
  setText(byId("lesson-state"), t("lesson_state", { count: robots.length, done }));
  const names = lesson.tasks.map((title, at) => t("lesson_task", { number: at + 1, title }));
  chosen = Math.min(chosen, names.length);
  setText(byId("lesson-task"), names[chosen - 1]);
  const menu = byId("lesson-tasks");
  if (names.join() === [...menu.children].map((one) => one.textContent).join()) return;
  menu.replaceChildren(...names.map((name, at) => make("li", "", makeButton(name, "small quiet", () => choose(at + 1)))));
}

/** Not a list of the browser's own: where that is open, Esc and the space bar reach no page, and stop nothing. */
function choose(number) {
  chosen = number;
  byId("lesson-task").parentElement.open = false;
  byId("lesson-task").focus();
  drawLesson();
}

function draw() {
  drawLesson();
  for (const robot of robots) drawCard(robot);
  for (const { said } of cards.values()) {
    said.tabIndex = said.scrollHeight > said.clientHeight ? 0 : -1; // what overflows is read by keys, too
  }
  const moving = robots.filter((robot) => robot.moving).length;
  setText(byId("class-state"), t("class_state", { count: robots.length, moving }));
  const isLatched = robots.some((robot) => robot.emergency);
  if (isLatched && byId("release-banner").hidden) restButton(byId("release"));
  byId("release-banner").hidden = !isLatched;
}

function hearStop(message) {
  const said = { asked: "stop_asked", stopped: "stop_heard_all", unheard: "stop_unheard", gone: "stop_gone" }[message.is];
  if (!said) return;
  clearTimeout(saidTimer);
  restButton(byId("release"));
  setText(byId("stop-said"), t(said));
  saidTimer = setTimeout(() => setText(byId("stop-said"), ""), SAID_MS);
}

on("open", () => {
  setBanner(byId("connection-banner"), "");
  send({ do: "language", code: language() });
});
on("hello", (message) => {
  if (message.recorded) showRecordings();
  if (message.task && !byId("task").value) byId("task").value = message.task;
});
on("class", (message) => {
  robots = message.robots;
  lesson = message.lesson;
  draw();
});
on("refused", (message) => notice(message.text));
on("closed", () => setBanner(byId("connection-banner"), t("no_connection")));
on("denied", (message) => setBanner(byId("connection-banner"), t(message.status === 429 ? "denied_wait" : "denied")));
onStop(hearStop);
startLanguageMenu();
startMenus();
onLanguage((code) => {
  send({ do: "language", code });
  draw();
});
byId("release").addEventListener("click", () => send({ do: "release" }));
byId("task-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const text = byId("task").value.trim();
  if (!text) notice(t("task_empty"));
  else if (send({ do: "task", text })) notice(t("task_handed_out"));
});
byId("lesson-form").addEventListener("submit", (event) => {
  event.preventDefault();
  if (send({ do: "move_to", number: chosen })) notice(t("lesson_moved", { number: chosen }));
});
startRecordings(notice);
await setLanguage(firstLanguage());
connect("/class");
