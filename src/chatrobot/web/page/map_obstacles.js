/**
 * Obstacles that a person puts into the simulation. While "Obstacle" is pressed a tap puts one there, or takes away the
 * one that was tapped, and a drag moves one; else the map is as without any. Enter does at the target what a tap does.
 */

import { on, send, state } from "./connection.js";
import { byId, isPressed, setPressed } from "./dom.js";
import { t } from "./words.js";

const RADIUS_M = 0.2;
const GRAB_M = 0.12;

const button = byId("obstacle");
let grabbed = null;

function mayPut() {
  const hello = state.hello;
  return Boolean(hello) && hello.robot.simulated && (state.steers || hello.role === "teacher");
}

function middleAndRadius(points) {
  const sum = points.reduce(([x, y], one) => [x + one[0], y + one[1]], [0, 0]);
  const [x, y] = [sum[0] / points.length, sum[1] / points.length];
  return { x, y, radius: Math.max(...points.map((one) => Math.hypot(one[0] - x, one[1] - y))) };
}

function added() {
  return state.hello.world.obstacles.filter((one) => one.added).map((one) => ({ name: one.name, ...middleAndRadius(one.polygon) }));
}

function under([x, y]) {
  return added().find((one) => Math.hypot(x - one.x, y - one.y) <= one.radius + GRAB_M);
}

function put(name, [x, y], radius) {
  send({ do: "obstacle", name, x_m: x, y_m: y, radius_m: radius });
}

function freeName() {
  const taken = new Set(added().map((one) => one.name));
  let number = 1;
  while (taken.has(t("obstacle_name", { number }))) number += 1;
  return t("obstacle_name", { number });
}

/** Whether a tap puts an obstacle there, and sends the robot nowhere. */
export function isPutting() {
  return mayPut() && isPressed(button);
}

/** Put an obstacle at this point of the floor, or take away the one that is there. */
export function putAt(spot) {
  const there = under(spot);
  if (there) send({ do: "obstacle", name: there.name });
  else put(freeName(), spot, RADIUS_M);
}

/** Take hold of the obstacle at this point, if one was put there. */
export function grab(spot) {
  const there = isPutting() ? under(spot) : null;
  grabbed = there ? { ...there, spot, dx: there.x - spot[0], dy: there.y - spot[1] } : null;
  return Boolean(grabbed);
}

export function drag([x, y]) {
  if (grabbed) grabbed.spot = [x, y];
}

/** Let go: it stands there from now on, where Motion allows that. */
export function drop(hasMoved) {
  if (grabbed && hasMoved) put(grabbed.name, [grabbed.spot[0] + grabbed.dx, grabbed.spot[1] + grabbed.dy], grabbed.radius);
  grabbed = null;
}

/** Where the obstacle is that is being dragged: { x, y, radius }, or null. */
export function dragged() {
  return grabbed && { x: grabbed.spot[0] + grabbed.dx, y: grabbed.spot[1] + grabbed.dy, radius: grabbed.radius };
}

export function startObstacles(redraw) {
  const show = () => {
    button.hidden = !mayPut();
    if (button.hidden) setPressed(button, false);
  };
  const heading = byId("heading");
  button.addEventListener("click", () => {
    setPressed(button, !isPressed(button));
    setPressed(heading, false);
  });
  heading.addEventListener("click", () => setPressed(button, false));
  addEventListener("keydown", (event) => event.key === "Escape" && setPressed(button, false));
  for (const kind of ["open", "steering", "closed"]) on(kind, show);
  on("event", ({ event }) => {
    if (event.event !== "obstacle_changed") return;
    const world = state.hello.world;
    world.obstacles = world.obstacles.filter((one) => !(one.added && one.name === event.obstacle));
    if (event.outline_m.length) world.obstacles.push({ name: event.obstacle, added: true, polygon: event.outline_m });
    redraw();
  });
}
