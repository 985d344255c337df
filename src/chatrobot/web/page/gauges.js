/** Gauges: how fast, how near, how full; and what the governor limits, and why. */

import { on, state } from "./connection.js";
import { byId, setText } from "./dom.js";
import { decimal, onLanguage, t } from "./words.js";

const UNKNOWN = "–";
const NEAR_M = 3;
const LIMITED_MS = 2500;
const LEAST_MPS = 0.01;
const LEAST_RADPS = 0.02;

const limited = byId("limited");
let telemetry = null;
let limitedTimer = 0;
let isLatched = false;
let pausedTurn = null;

function show(id, value, most, text) {
  const gauge = byId(id);
  const meter = gauge.querySelector("i");
  setText(gauge.querySelector("b"), text);
  const share = most > 0 && value !== null ? Math.max(0, Math.min(1, value / most)) : 0;
  meter.style.setProperty("--share", share);
  meter.setAttribute("aria-valuemin", "0");
  meter.setAttribute("aria-valuemax", String(most));
  meter.setAttribute("aria-valuenow", String(value === null ? 0 : Math.min(most, Number(value.toFixed(2)))));
  meter.setAttribute("aria-valuetext", text);
}

function draw() {
  if (!state.hello) return;
  const limits = state.hello.robot.limits;
  const twist = telemetry ? telemetry.twist : { vx_mps: 0, vy_mps: 0, wz_radps: 0 };
  const speed = Math.hypot(twist.vx_mps, twist.vy_mps);
  const rate = (Math.abs(twist.wz_radps) * 180) / Math.PI;
  const mostRate = (limits.max_rate_radps * 180) / Math.PI;
  const of = (value, most, digits) => ({ value: decimal(value, digits), most: decimal(most, digits) });
  const measured = (text) => (telemetry ? text : UNKNOWN);
  show("gauge-speed", speed, limits.max_speed_mps, measured(t("mps", of(speed, limits.max_speed_mps, 2))));
  show("gauge-rate", rate, mostRate, measured(t("degps", of(rate, mostRate, 0))));
  const near = telemetry ? telemetry.nearest_obstacle_m : null;
  const nearest = near === null ? t("nothing_near") : t("metres", { value: decimal(near, 2) });
  show("gauge-near", near, NEAR_M, measured(nearest));
  byId("gauge-near").hidden = !state.hello.robot.has_lidar;
  byId("gauge-near").classList.toggle("warn", near !== null && near < 0.3);
  const battery = telemetry ? telemetry.battery_percent : null;
  byId("gauge-battery").hidden = battery === null;
  if (battery !== null) show("gauge-battery", battery, 100, `${battery.toFixed(0)} %`);
  byId("gauge-battery").classList.toggle("warn", battery !== null && battery < 20);
}

/** By what it does or by what is being done: a stick moves it without a plan. */
export function isMoving() {
  if (!telemetry) return false;
  const { vx_mps: x, vy_mps: y, wz_radps: turn } = telemetry.twist;
  return telemetry.moving || Math.hypot(x, y) > LEAST_MPS || Math.abs(turn) > LEAST_RADPS;
}

function drawState() {
  const chip = byId("robot-state");
  let key = "state_standing";
  if (!state.isOpen) key = "state_unknown";
  else if (state.isSilent) key = "state_silent";
  else if (isLatched) key = "state_emergency";
  else if (isMoving()) key = "state_moving";
  else if (pausedTurn !== null) key = "state_paused";
  chip.dataset.state = key;
  setText(chip, t(key));
  byId("resume").hidden = pausedTurn === null;
  byId("pause").hidden = pausedTurn !== null;
  drawLatched();
}

/** Who may not release an emergency stop reads who does. */
function drawLatched() {
  const mayRelease = state.may.has("release");
  const elsewhere = state.hello && state.hello.role === "pupil" ? "latched_pupil" : "latched_elsewhere";
  setText(byId("latched"), t(mayRelease ? "latched" : elsewhere));
  byId("release").hidden = !mayRelease;
  byId("release-banner").hidden = !isLatched;
}

function limit(text) {
  clearTimeout(limitedTimer);
  setText(limited, text);
  setText(byId("drive-limited"), text);
  limited.classList.toggle("on", Boolean(text));
  if (text) limitedTimer = setTimeout(() => limit(""), LIMITED_MS);
}

function hear({ event, text }) {
  if (event.event === "telemetry") telemetry = event;
  else if (event.event === "limited") {
    if (!state.isReplaying) limit([].concat(text || event.rule).join(" "));
  } else if (event.event === "paused") pausedTurn = event.turn;
  else if (["started", "result", "finished"].includes(event.event)) {
    if (event.event === "started" || event.turn === pausedTurn) pausedTurn = null; // a question leaves it paused
    limit("");
  } else return;
  if (event.event === "telemetry") draw();
  drawState();
}

export function startGauges() {
  on("open", () => {
    telemetry = null;
    pausedTurn = null;
    isLatched = Boolean(state.hello.emergency);
    draw();
    drawState();
  });
  for (const end of ["closed", "silence"]) {
    on(end, () => {
      telemetry = null; // what was measured last is not so any more
      draw();
      drawState();
    });
  }
  on("emergency", (message) => {
    isLatched = message.set;
    drawState();
  });
  on("steering", drawState);
  on("still", () => !telemetry || isLatched || limited.textContent || limit(t("stick_still")));
  on("event", hear);
  onLanguage(() => {
    draw();
    drawState();
  });
}
