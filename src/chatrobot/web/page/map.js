/** The map: what is known, kept up to date and drawn when something changed. */

import { on, send, state, tell } from "./connection.js";
import { byId, isPressed, setPressed, setText } from "./dom.js";
import { Drawing, readColours } from "./map_drawing.js";
import { dragged, startObstacles } from "./map_obstacles.js";
import { startPointing } from "./map_pointing.js";
import { View } from "./map_view.js";
import { onLanguage, t } from "./words.js";

const LEAST_STEP_M = 0.02;
const MOST_TRAIL = 6000;
const SUMMARY_MS = 2000;
const AROUND_M = 2.5;

const canvas = byId("canvas");
const floor = byId("floor");
const follow = byId("follow");
const view = new View();
const known = { pose: null, trail: [], path: [], end: null, turn: 0, scan: [], epoch: null, target: null };
let colours = null;
let isDue = false;
let isFitted = false;
let summaryMs = 0;

/** Whether a way that was pointed at is asked about before it is driven. */
export function asksBeforeTaps() {
  return isPressed(byId("ask-taps"));
}

function redraw() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(draw);
}

function draw() {
  isDue = false;
  if (!state.hello || view.width < 2) return;
  colours = colours || readColours();
  const { robot, world } = state.hello;
  if (isPressed(follow) && known.pose) view.centre(known.pose.x_m, known.pose.y_m);
  const context = canvas.getContext("2d");
  const ratio = canvas.width / view.width;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const drawing = new Drawing(context, view, colours, getComputedStyle(floor).font);
  drawing.ground(world);
  drawing.obstacles(world);
  if (dragged()) drawing.ghost(dragged());
  drawing.path(known.trail);
  drawing.stroke("driven", 4);
  drawing.path(known.path);
  drawing.stroke("rehearsed", 3, [2, 7]);
  drawing.lidar(known.scan);
  drawing.places(world.places);
  drawing.names();
  if (known.end) drawing.robot(known.end, robot.footprint, true);
  if (known.pose) drawing.robot(known.pose, robot.footprint);
  if (known.target) drawing.target(known.target);
  drawing.scaleBar();
}

function resize() {
  const { width, height } = floor.getBoundingClientRect();
  const ratio = Math.min(devicePixelRatio || 1, 2);
  [view.width, view.height] = [Math.max(1, width), Math.max(1, height)];
  [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (!isFitted || !view.isMoved) fit();
  draw();
}

/** Show all that is known, and the robot. */
function fit() {
  if (!state.hello || view.width < 2) return;
  const { world } = state.hello;
  const { x_m: x, y_m: y } = known.pose || { x_m: 0, y_m: 0 };
  const points = [...(world.area || []), ...world.places.map((place) => [place.x_m, place.y_m])];
  for (const one of world.obstacles) {
    points.push(...(one.polygon || [[one.circle.x_m, one.circle.y_m]]));
  }
  const around = points.length ? [[x, y]] : [[x - AROUND_M, y - AROUND_M], [x + AROUND_M, y + AROUND_M]];
  view.fit([...points, ...around, ...known.path]);
  isFitted = true;
}

function noteTelemetry(event) {
  if (known.epoch !== null && event.odometry_epoch !== known.epoch) known.trail = [];
  known.epoch = event.odometry_epoch;
  known.pose = event.pose;
  const last = known.trail[known.trail.length - 1];
  const { x_m: x, y_m: y } = event.pose;
  if (!last || Math.hypot(x - last[0], y - last[1]) > LEAST_STEP_M) known.trail.push([x, y]);
  if (known.trail.length > MOST_TRAIL) known.trail.shift();
  if (!view.isMoved && !view.shows(x, y)) fit(); // it drove off, or stood elsewhere before this page was loaded
  if (performance.now() - summaryMs < SUMMARY_MS) return;
  summaryMs = performance.now();
  const { yaw_rad: yaw } = event.pose; // it counts turns
  const heading = ((Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180) / Math.PI).toFixed(0);
  setText(byId("map-summary"), t("map_summary", { x: x.toFixed(2), y: y.toFixed(2), heading }));
}

const heard = {
  telemetry: noteTelemetry,
  rehearsed(event) {
    known.path = event.path;
    known.turn = event.turn;
    known.end = event.path.length ? event.end : null;
  },
  result(event) {
    if (event.turn === known.turn) [known.path, known.end, known.target] = [[], null, null];
  },
};

heard.finished = heard.result;

function go() {
  if (!known.target) return;
  const { x, y, yaw } = known.target;
  const ask = asksBeforeTaps();
  if (!state.steers || !send({ do: "go", x_m: x, y_m: y, yaw_rad: yaw, ask })) known.target = null;
  else if (ask) tell({ is: "asking" });
  redraw();
}

export function startMap() {
  on("open", () => {
    const yaw = state.hello.world.start_yaw_rad || 0;
    view.turn(yaw);
    Object.assign(known, { path: [], end: null, scan: [], target: null });
    if (!isFitted) fit();
    redraw();
  });
  on("event", ({ event }) => {
    if (!heard[event.event]) return;
    heard[event.event](event);
    redraw();
  });
  on("scan", (message) => {
    known.scan = message.points_m;
    redraw();
  });
  on("refused", (message) => {
    if (message.do === "go") known.target = null;
    redraw();
  });
  on("places", redraw);
  onLanguage(redraw);
  startObstacles(redraw);
  startPointing({ view, known, redraw, go, release: () => setPressed(follow, false) });
  follow.addEventListener("click", () => {
    setPressed(follow, !isPressed(follow));
    redraw();
  });
  byId("ask-taps").addEventListener("click", (event) => setPressed(event.target, !isPressed(event.target)));
  byId("fit").addEventListener("click", () => {
    setPressed(follow, false);
    fit();
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    colours = null;
    redraw();
  });
  new ResizeObserver(resize).observe(floor);
}
