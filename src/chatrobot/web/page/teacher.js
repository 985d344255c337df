/** The teacher's page: all robots of a class; stop one or all, release, look in, hand out a task and the links. */

import { connect, on, send } from "./connection.js";
import { byId, make, makeButton, setBanner, setText } from "./dom.js";
import { onStop } from "./stop.js";
import { firstLanguage, language, onLanguage, setLanguage, t } from "./words.js";

const NOTICE_MS = 6000;
const SAID_MS = 2500;
const REALLY_MS = 4000;

const list = byId("robots");
const cards = new Map();
let robots = [];
let noticeTimer = 0;
let saidTimer = 0;

function notice(text) {
  clearTimeout(noticeTimer);
  setBanner(byId("notice-banner"), text);
  if (text) noticeTimer = setTimeout(() => notice(""), NOTICE_MS);
}

async function copyLink(robot) {
  const link = new URL(robot.link, location.href).href;
  try {
    await navigator.clipboard.writeText(link);
    notice(t("link_copied", { name: robot.name }));
  } catch {
    notice(link); // a page that is not secure may not write there: it can be copied by hand
  }
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
    doing: make("p", "doing"),
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
  const buttons = make("div", "buttons", card.stop, card.release, card.link, card.end, card.open);
  card.item.append(head, card.who, card.where, card.doing, buttons);
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
  setText(card.who, robot.pages ? t("pages", { count: robot.pages }) : t("pages_none"));
  const [x, y, yaw] = robot.pose || [0, 0, 0];
  const heading = Math.round((yaw * 180) / Math.PI);
  setText(card.where, robot.pose ? t("pose", { x: x.toFixed(2), y: y.toFixed(2), heading }) : "");
  setText(card.doing, robot.plan_text || robot.reply);
  card.doing.dataset.outcome = robot.plan_text ? "" : robot.outcome;
  label(card.stop, t("stop"), name);
  label(card.release, t("release"), name);
  label(card.link, t("link_copy"), name);
  label(card.end, t(card.item.classList.contains("asked") ? "link_end_really" : "link_end"), name);
  label(card.open, t("robot_open"), name);
  card.release.hidden = !robot.emergency;
}

function draw() {
  for (const robot of robots) drawCard(robot);
  const moving = robots.filter((robot) => robot.moving).length;
  setText(byId("class-state"), t("class_state", { count: robots.length, moving }));
  byId("release").hidden = !robots.some((robot) => robot.emergency);
}

function hearStop(message) {
  const said = { asked: "stop_asked", stopped: "stop_heard_all", unheard: "stop_unheard", gone: "stop_gone" }[message.is];
  if (!said) return;
  clearTimeout(saidTimer);
  setText(byId("stop-said"), t(said));
  saidTimer = setTimeout(() => setText(byId("stop-said"), ""), SAID_MS);
}

on("open", () => {
  setBanner(byId("connection-banner"), "");
  send({ do: "language", code: language() });
});
on("hello", (message) => {
  if (message.task && !byId("task").value) byId("task").value = message.task;
});
on("class", (message) => {
  robots = message.robots;
  draw();
});
on("refused", (message) => notice(message.text));
on("closed", () => setBanner(byId("connection-banner"), t("no_connection")));
on("denied", (message) => setBanner(byId("connection-banner"), t(message.status === 429 ? "denied_wait" : "denied")));
onStop(hearStop);
onLanguage((code) => {
  byId("language").textContent = t("other_language");
  byId("language").lang = code === "en" ? "zh-Hans" : "en";
  send({ do: "language", code });
  draw();
});
byId("language").addEventListener("click", () => setLanguage(language() === "en" ? "zh" : "en"));
byId("release").addEventListener("click", () => send({ do: "release" }));
byId("task-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const text = byId("task").value.trim();
  if (text && send({ do: "task", text })) notice(t("task_handed_out"));
});
await setLanguage(firstLanguage());
connect("/class");
