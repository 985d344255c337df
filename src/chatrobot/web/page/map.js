/** The map: what is known, kept up to date and drawn when something changed. */

import { on, send, state, tell } from "./connection.js";
import { byId, isPressed, setPressed, setText } from "./dom.js";
import { Drawing, readColours } from "./map_drawing.js";
import { dragged, startObstacles } from "./map_obstacles.js";
import { startPointing } from "./map_pointing.js";
import { Trail } from "./map_trail.js";
import { View } from "./map_view.js";
import { decimal, onLanguage, t } from "./words.js";

const SUMMARY_MS = 2000;
const AROUND_M = 2.5;
const GAP_PX = 12; // between what is shown and the buttons
const FREE_PX = { bottom: 40, left: 24 }; // for the scale bar

const canvas = byId("canvas");
const floor = byId("floor");
const follow = byId("follow");
const view = new View();
const trail = new Trail();
const known = { pose: null, path: [], end: null, turn: 0, waits: false, scan: [], target: null };
/** What the target was last sent as, { text, turn }, until that turn has ended. */
let order = null;
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
  drawing.path(trail.points);
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
  view.fit([...points, ...around, ...known.path], insets());
  isFitted = true;
}

/** How much of the map's edges the buttons cover. */
function insets() {
  const [box, tools, zoom] = [floor, byId("map-tools"), byId("zoom-tools")].map((one) => one.getBoundingClientRect());
  return { ...FREE_PX, top: tools.bottom - box.top + GAP_PX, right: box.right - zoom.left + GAP_PX };
}

function noteTelemetry(event) {
  trail.note(event);
  known.pose = event.pose;
  const { x_m: x, y_m: y } = event.pose;
  if (!view.isMoved && !view.shows(x, y)) fit(); // it drove off, or stood elsewhere before this page was loaded
  if (performance.now() - summaryMs < SUMMARY_MS) return;
  summaryMs = performance.now();
  const { yaw_rad: yaw } = event.pose; // it counts turns
  const heading = decimal((Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180) / Math.PI, 0);
  setText(byId("map-summary"), t("map_summary", { x: decimal(x, 2), y: decimal(y, 2), heading }));
}

const heard = {
  telemetry: noteTelemetry,
  rehearsed(event) {
    known.path = event.path;
    known.turn = event.turn;
    known.waits = event.needs_approval;
    known.end = event.path.length ? event.end : null;
  },
  started(event) {
    if (event.turn === known.turn) known.waits = false;
  },
  result(event) {
    if (event.turn === known.turn) Object.assign(known, { path: [], end: null, waits: false });
    if (event.turn === (order ? order.turn : known.turn)) known.target = order = null;
  },
};

heard.finished = heard.result;

/** The target to a centimetre and a degree: the text that is shown means the very same point when it is typed. */
function asSaid({ x, y, yaw }) {
  const [x_m, y_m] = [x, y].map((value) => Number(value.toFixed(2)) || 0);
  const heading = yaw === null ? null : Math.round((Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180) / Math.PI) || 0;
  const text = t(heading === null ? "go_point" : "go_point_facing", { x: x_m.toFixed(2), y: y_m.toFixed(2), heading });
  return { x_m, y_m, yaw_rad: heading === null ? null : (heading * Math.PI) / 180, text };
}

function go() {
  if (!known.target) return;
  const said = asSaid(known.target);
  const ask = asksBeforeTaps();
  order = { text: said.text, turn: 0 };
  if (!state.steers || !send({ do: "go", ...said, ask })) known.target = order = null;
  else if (ask) tell({ is: "asking" });
  redraw();
}

/** Send the robot to the target by a key; once more is the yes to the way that is asked about. */
function enter() {
  if (!order || !known.target || order.text !== asSaid(known.target).text) go();
  else if (known.waits && known.turn === order.turn) send({ do: "approve", turn: order.turn, yes: true });
}

export function startMap() {
  on("open", () => {
    const yaw = state.hello.world.start_yaw_rad || 0;
    view.turn(yaw);
    Object.assign(known, { path: [], end: null, waits: false, scan: [], target: null });
    order = null;
    trail.restore();
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
  on("said", ({ text, turn, by }) => {
    if (order && order.text === text && state.mine.has(String(by))) order.turn = turn;
  });
  on("refused", (message) => {
    if (message.do === "go") known.target = order = null;
    redraw();
  });
  on("places", redraw);
  onLanguage(redraw);
  startObstacles(redraw);
  startPointing({ view, known, redraw, go, enter, release: () => setPressed(follow, false) });
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
  const sizes = new ResizeObserver(resize);
  for (const one of [floor, byId("map-tools")]) sizes.observe(one);
}
