/** Who steers: one page does, the others watch; what is refused, and a connection that is gone, are said. */

import { on, send, state } from "./connection.js";
import { byId, restButton, setBanner, setText } from "./dom.js";
import { isMoving } from "./gauges.js";
import { isStopLineOpen, onStop } from "./stop.js";
import { onLanguage, t } from "./words.js";

const NOTICE_MS = 6000;
const STOP_SAID_MS = 2500;
const STOP_LINE_MS = 2000;
const STEERERS = [
  "send", "pause", "resume", "heading", "ask-taps", "stick-speed", "side-left", "side-right", "plan-run", "plan-edit",
  "program-run", "program-edit", "program-save",
];

let by = null;
let name = "";
let lost = "";
let noticeTimer = 0;
let stopTimer = 0;
let lineTimer = 0;

function drawSteering() {
  let key = "steers_nobody";
  if (state.steers) key = "steers_you";
  else if (by) key = "steers_other";
  setText(byId("steering-state"), state.isOpen ? t(key, { name }) : "");
  byId("steering-state").dataset.state = key;
  const mayTake = state.isOpen && !state.steers && state.may.has("take");
  byId("take").hidden = !mayTake;
  byId("give").hidden = !state.steers;
  const isWatching = state.isOpen && !state.steers;
  setBanner(byId("watching-banner"), isWatching ? t(mayTake ? "watching_may_take" : "watching") : "");
  document.body.classList.toggle("watching", !state.steers);
  for (const id of STEERERS) byId(id).disabled = !state.steers;
}

/** Say something for a moment. */
export function notice(text) {
  clearTimeout(noticeTimer);
  setBanner(byId("notice-banner"), text);
  if (text) noticeTimer = setTimeout(() => notice(""), NOTICE_MS);
}

function drawConnection() {
  let text = "";
  if (lost) text = t(lost);
  else if (state.isOpen && state.hello.stop_port && !isStopLineOpen()) text = t("stop_line_gone");
  setBanner(byId("connection-banner"), text);
}

function hearSteering(message) {
  const [before, did] = [by, state.steers];
  by = message.by;
  name = message.name || "";
  drawSteering();
  const isTaken = before && by && before !== by;
  if (isTaken && before === state.hello.you) notice(t("taken_from_you", { name }));
  else if (isTaken && did) notice(t("taken_by_you"));
  else if (before !== by) notice(""); // what was refused may be asked for now
}

function hearStop(message) {
  const said = { asked: state.isSilent ? "stop_unanswered" : "stop_asked", stopped: "stop_heard", unheard: "stop_unheard", gone: "stop_gone" }[message.is];
  if (said) {
    restButton(byId("release"));
    clearTimeout(stopTimer);
    setText(byId("stop-said"), t(said));
    byId("stop").classList.add("pressed");
    stopTimer = setTimeout(() => {
      setText(byId("stop-said"), "");
      byId("stop").classList.remove("pressed");
    }, STOP_SAID_MS);
  }
  if (message.is === "line") {
    clearTimeout(lineTimer);
    lineTimer = setTimeout(drawConnection, isStopLineOpen() ? 0 : STOP_LINE_MS);
  }
}

/** In a class, whose robot it is comes first: a teacher looks in on many. */
function drawTitle() {
  if (!state.hello) return;
  const { robot, room } = state.hello;
  const title = [...(room ? [t("pupil", { name: room })] : []), robot.title || robot.name].join(" · ");
  setText(byId("robot-title"), title);
  document.title = `${title} · ChatRobot`;
}

export function startSteering() {
  on("open", () => {
    lost = "";
    const steering = state.hello.steering;
    by = steering && steering.by;
    name = (steering && steering.name) || "";
    drawTitle();
    clearTimeout(lineTimer);
    setBanner(byId("connection-banner"), "");
    lineTimer = setTimeout(drawConnection, STOP_LINE_MS);
    drawSteering();
  });
  on("closed", (message) => {
    if (message.was) lost = byId("take").hidden ? "lost_steering" : "lost_watching";
    else if (!lost) lost = "no_connection";
    drawConnection();
    drawSteering();
  });
  on("silence", () => document.body.classList.toggle("silent", state.isSilent));
  on("denied", (message) => {
    lost = message.status === 429 ? "denied_wait" : "denied";
    drawConnection();
  });
  on("steering", hearSteering);
  on("refused", (message) => notice(message.text));
  on("emergency", () => restButton(byId("release")));
  on("gone", (message) => notice(message.text));
  onStop(hearStop);
  byId("take").addEventListener("click", () => send({ do: "take" }));
  byId("give").addEventListener("click", () => send({ do: "give" }));
  byId("pause").addEventListener("click", () => {
    if (send({ do: "pause" }) && !isMoving()) notice(t("pause_nothing"));
  });
  byId("resume").addEventListener("click", () => send({ do: "resume" }));
  byId("release").addEventListener("click", (event) => {
    send({ do: "release" });
    if (event.detail === 0) byId("say").focus(); // from the keyboard: its button goes away
  });
  onLanguage(() => {
    drawTitle();
    drawSteering();
    drawConnection();
  });
}
