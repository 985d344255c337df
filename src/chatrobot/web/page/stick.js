/**
 * The stick: keys and a pad, held to move. Sent at 20 Hz while it is held, and zero once when it is let go; beats go
 * with it, from the page's own thread, so that a page that is frozen is missed at once.
 */

import { on, send, state, tell } from "./connection.js";
import { byId, isField, keepInTab, setText, takeFromTab } from "./dom.js";
import { isMoving } from "./gauges.js";
import { decimal, onLanguage, t } from "./words.js";

const KEYS = {
  KeyW: [1, 0, 0], ArrowUp: [1, 0, 0], KeyS: [-1, 0, 0], ArrowDown: [-1, 0, 0],
  KeyA: [0, 0, 1], ArrowLeft: [0, 0, 1], KeyD: [0, 0, -1], ArrowRight: [0, 0, -1],
  KeyQ: [0, 1, 0], KeyE: [0, -1, 0],
};
const DEAD = 0.08;
const FULL = 1;
const STILL_MS = 800;
const KEPT = "chatrobot-stick-speed";

const held = new Set();
const pad = byId("pad");
const knob = byId("knob");
const speed = byId("stick-speed");
let pointer = null;
let lean = [0, 0];
let side = 0;
let isHeld = false;
let movedMs = 0;

function wanted() {
  let [x, y, turn] = [lean[0], side, lean[1]];
  for (const code of held) {
    x += KEYS[code][0];
    y += KEYS[code][1];
    turn += KEYS[code][2];
  }
  const robot = state.hello.robot;
  if (!robot.sideways && y) [y, turn] = [0, turn + y]; // a base that cannot go sideways turns
  const share = Number(speed.value) / 100;
  const cut = (value) => Math.max(-FULL, Math.min(FULL, value)) * share;
  return {
    do: "steer",
    vx_mps: cut(x) * robot.limits.max_speed_mps,
    vy_mps: cut(y) * (robot.limits.max_sideways_mps ?? robot.limits.max_speed_mps),
    wz_radps: cut(turn) * robot.limits.max_rate_radps,
  };
}

const isTouched = () => held.size > 0 || pointer !== null || side !== 0;

/** Tell the robot at once what the stick says now; after the last zero nothing. */
function update() {
  if (!state.hello) return;
  if (isTouched() && state.steers) {
    if (!isHeld) movedMs = performance.now();
    isHeld = true;
    send(wanted());
  } else if (isHeld) {
    isHeld = false;
    if (state.steers) send({ do: "steer", vx_mps: 0, vy_mps: 0, wz_radps: 0 });
  }
  pad.classList.toggle("held", isHeld);
}

function release() {
  held.clear();
  pointer = null;
  side = 0;
  lean = [0, 0];
  knob.style.transform = "";
  update();
}

function beat() {
  if (!state.steers) return;
  send({ do: "beat", held: isHeld });
  if (!isHeld) return;
  update();
  if (isMoving()) movedMs = performance.now();
  else if (performance.now() - movedMs > STILL_MS) tell({ is: "still" }); // what was held through a stop has to be let go
}

/** A key that is meant for a menu, a list or a text drives nothing; arrows are the map's and the slider's own. */
function drivesFrom(element, code) {
  return element === document.body || (element.matches("#floor, #stick-speed") && !code.startsWith("Arrow"));
}

function keyDown(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) {
    if (held.size) release(); // some systems tell no key coming up beside these
    return;
  }
  if (!(event.code in KEYS) || !drivesFrom(event.target, event.code) || event.isComposing) return;
  event.preventDefault();
  if (event.repeat || held.has(event.code)) return;
  held.add(event.code);
  update();
}

function keyUp(event) {
  if (held.delete(event.code)) update();
}

function movePad(event) {
  const box = pad.getBoundingClientRect();
  const radius = box.width / 2;
  let right = (event.clientX - box.left - radius) / radius;
  let up = -(event.clientY - box.top - radius) / radius;
  const length = Math.hypot(right, up);
  if (length > 1) [right, up] = [right / length, up / length];
  const past = (value) => (Math.abs(value) < DEAD ? 0 : value);
  lean = [past(up), -past(right)];
  knob.style.transform = `translate(${right * radius * 0.6}px, ${-up * radius * 0.6}px)`;
  update();
}

function startPad() {
  pad.addEventListener("pointerdown", (event) => {
    if (pointer !== null || event.button !== 0) return;
    event.preventDefault();
    pad.setPointerCapture(event.pointerId);
    pointer = event.pointerId;
    movePad(event);
  });
  pad.addEventListener("pointermove", (event) => event.pointerId === pointer && movePad(event));
  for (const ending of ["pointerup", "pointercancel", "lostpointercapture"]) {
    pad.addEventListener(ending, (event) => event.pointerId === pointer && release());
  }
}

function startSide(button, direction) {
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    button.setPointerCapture(event.pointerId);
    side = direction;
    update();
  });
  for (const ending of ["pointerup", "pointercancel", "lostpointercapture"]) {
    button.addEventListener(ending, () => {
      side = 0;
      update();
    });
  }
}

function showSpeed() {
  if (!state.hello) return;
  const text = t("mps_value", { value: decimal((Number(speed.value) / 100) * state.hello.robot.limits.max_speed_mps, 2) });
  setText(byId("stick-mps"), text);
  speed.setAttribute("aria-valuetext", text);
}

/** The speed is the robot's usual one until a person chooses another, which outlives a reload. */
function startSpeed() {
  let chosen = takeFromTab(KEPT);
  speed.addEventListener("input", () => {
    chosen = speed.value;
    showSpeed();
  });
  addEventListener("pagehide", () => chosen && keepInTab(KEPT, chosen));
  on("open", () => {
    const { defaults, limits } = state.hello.robot;
    const usual = defaults ? defaults.speed_mps / limits.max_speed_mps : 0.3;
    speed.value = chosen || String(Math.round(usual * 100));
    showSpeed();
  });
  onLanguage(showSpeed);
}

export function startStick() {
  addEventListener("keydown", keyDown);
  addEventListener("keyup", keyUp);
  addEventListener("blur", release);
  addEventListener("pagehide", release);
  addEventListener("contextmenu", release); // a menu takes the keys, and tells nobody
  document.addEventListener("freeze", release);
  document.addEventListener("visibilitychange", () => document.hidden && release());
  document.addEventListener("focusin", (event) => isField(event.target) && held.size && release());
  document.addEventListener("click", ({ target, detail }) => {
    const button = target.closest(":is(.dock, #map, #drive) button");
    if (button && detail) button.blur(); // a mouse leaves the focus there, and keys would drive no more
  });
  startPad();
  startSpeed();
  startSide(byId("side-left"), 1);
  startSide(byId("side-right"), -1);
  on("open", () => {
    byId("sideways").hidden = !state.hello.robot.sideways;
    release();
  });
  on("closed", () => {
    isHeld = false;
    release();
  });
  on("steering", () => state.steers || release());
  new Worker("beats.js").onmessage = beat;
}
