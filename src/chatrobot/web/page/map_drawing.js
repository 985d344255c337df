/** Draws the floor: what stands there, places, paths, what the lidar sees, the robot. Colours come from the style. */

import { obstacleName, placeName } from "./places.js";
import { decimal, t } from "./words.js";

const WALL_M = 0.16;
const COLOURS = [
  "floor", "grid", "area", "wall", "thing", "thing-edge", "added", "added-edge", "label", "place", "driven", "rehearsed",
  "lidar", "robot", "robot-edge", "ring", "target", "halo",
];

/** Return the colours of the style that holds now. */
export function readColours() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(COLOURS.map((name) => [name, style.getPropertyValue(`--map-${name}`).trim()]));
}

export class Drawing {
  constructor(context, view, colours, font) {
    Object.assign(this, { context, view, colours, font });
    this.labels = [];
    this.pinned = []; // never left out
  }

  path(points, isClosed = false) {
    const context = this.context;
    context.beginPath();
    points.forEach(([x, y], at) => {
      const [right, down] = this.view.toScreen(x, y);
      if (at) context.lineTo(right, down);
      else context.moveTo(right, down);
    });
    if (isClosed) context.closePath();
  }

  fill(colour) {
    this.context.fillStyle = this.colours[colour];
    this.context.fill();
  }

  stroke(colour, width, dash = []) {
    Object.assign(this.context, { strokeStyle: this.colours[colour], lineWidth: width, lineJoin: "round", lineCap: "round" });
    this.context.setLineDash(dash);
    this.context.stroke();
    this.context.setLineDash([]);
  }

  ground(world) {
    const { context, view } = this;
    context.fillStyle = this.colours.floor;
    context.fillRect(0, 0, view.width, view.height);
    if (world.area) {
      this.path(world.area, true);
      this.fill("area");
    }
    const step = view.scale < 22 ? 5 : 1;
    const [left, right] = [view.x - view.width / 2 / view.scale, view.x + view.width / 2 / view.scale];
    const [low, high] = [view.y - view.height / 2 / view.scale, view.y + view.height / 2 / view.scale];
    context.beginPath();
    for (let x = Math.ceil(left / step) * step; x < right; x += step) this.line((x - view.x) * view.scale, true);
    for (let y = Math.ceil(low / step) * step; y < high; y += step) this.line((y - view.y) * view.scale, false);
    this.stroke("grid", 1);
    if (world.area) {
      this.path(world.area, true);
      this.stroke("thing-edge", 1.5, [6, 5]);
    }
  }

  line(offset, isUpright) {
    const { context, view } = this;
    const at = Math.round(isUpright ? view.width / 2 + offset : view.height / 2 - offset) + 0.5;
    context.moveTo(isUpright ? at : 0, isUpright ? 0 : at);
    context.lineTo(isUpright ? at : view.width, isUpright ? view.height : at);
  }

  obstacles(world) {
    const named = new Set(world.places.map((place) => placeName(place).toLowerCase()));
    for (const one of world.obstacles) {
      if (one.circle) this.disc(one.circle.x_m, one.circle.y_m, one.circle.radius_m);
      else this.path(one.polygon, true);
      if (one.added) {
        this.added(one);
        continue;
      }
      const isWall = one.polygon && thickness(one.polygon) < WALL_M;
      this.fill(isWall ? "wall" : "thing");
      if (isWall) continue;
      this.stroke("thing-edge", 1);
      const name = obstacleName(one, world.places);
      if (!named.has(name.toLowerCase())) this.labels.push({ name, at: this.middleOf(one), colour: "label" });
    }
  }

  /** What a person put there is told from the furniture: its number, or its name, is never left out. */
  added(one) {
    this.fill("added");
    this.stroke("added-edge", 2);
    const name = /\d+$/.exec(one.name)?.[0] ?? one.name;
    this.pinned.push({ name, at: this.middleOf(one), colour: "added-edge" });
  }

  middleOf(one) {
    const [x, y] = one.circle ? [one.circle.x_m, one.circle.y_m] : middle(one.polygon);
    return this.view.toScreen(x, y);
  }

  disc(x, y, radius) {
    const [right, down] = this.view.toScreen(x, y);
    this.context.beginPath();
    this.context.arc(right, down, radius * this.view.scale, 0, 2 * Math.PI);
  }

  /** Where an obstacle would stand that is being dragged. */
  ghost({ x, y, radius }) {
    this.disc(x, y, radius);
    this.stroke("target", 2, [4, 4]);
  }

  places(places) {
    for (const place of places) {
      const [right, down] = this.view.toScreen(place.x_m, place.y_m);
      this.context.beginPath();
      this.context.arc(right, down, 4, 0, 2 * Math.PI);
      this.fill("place");
      this.stroke("halo", 1.5);
      this.labels.unshift({ name: placeName(place), at: [right, down - 12], colour: "place" });
    }
  }

  /** Write the names; one that would lie on another is left out. */
  names() {
    const { context } = this;
    const taken = [];
    Object.assign(context, { font: this.font, textAlign: "center", textBaseline: "middle", lineWidth: 3, lineJoin: "round" });
    for (const { name, at: [right, down], colour } of [...this.pinned, ...this.labels]) {
      const half = context.measureText(name).width / 2 + 3;
      const box = [right - half, down - 9, right + half, down + 9];
      if (taken.some((one) => box[0] < one[2] && one[0] < box[2] && box[1] < one[3] && one[1] < box[3])) continue;
      taken.push(box);
      context.strokeStyle = this.colours.halo;
      context.strokeText(name, right, down);
      context.fillStyle = this.colours[colour];
      context.fillText(name, right, down);
    }
  }

  lidar(points) {
    this.context.fillStyle = this.colours.lidar;
    for (const [x, y] of points) {
      const [right, down] = this.view.toScreen(x, y);
      this.context.fillRect(right - 1.5, down - 1.5, 3, 3);
    }
  }

  robot(pose, footprint, isGhost = false) {
    const { context, view } = this;
    const [cos, sin] = [Math.cos(pose.yaw_rad), Math.sin(pose.yaw_rad)];
    const place = ([x, y]) => [pose.x_m + cos * x - sin * y, pose.y_m + sin * x + cos * y];
    const shape = footprint.polygon_m;
    if (shape && shape.length > 2) this.path(shape.map(place), true);
    else this.disc(pose.x_m, pose.y_m, footprint.radius_m);
    if (isGhost) {
      this.stroke("rehearsed", 2, [4, 4]);
    } else {
      this.fill("robot");
      this.stroke("robot-edge", 2);
    }
    const [right, down] = view.toScreen(pose.x_m, pose.y_m);
    this.arrow(right, down, pose, Math.max(9, footprint.radius_m * view.scale * 0.55), isGhost);
  }

  /** Which way it looks; in a ring, so that it is found on a large map. */
  arrow(right, down, pose, size, isGhost) {
    const { context, view } = this;
    if (!isGhost) {
      context.beginPath();
      context.arc(right, down, Math.max(20, size * 2.4), 0, 2 * Math.PI);
      this.fill("ring");
    }
    context.save();
    context.translate(right, down);
    context.rotate(view.angle(pose.yaw_rad));
    context.beginPath();
    context.moveTo(size, 0);
    context.lineTo(-size * 0.55, size * 0.6);
    context.lineTo(-size * 0.25, 0);
    context.lineTo(-size * 0.55, -size * 0.6);
    context.closePath();
    if (isGhost) this.stroke("rehearsed", 2);
    else this.fill("robot-edge");
    context.restore();
  }

  target({ x, y, yaw }) {
    const { context, view } = this;
    const [right, down] = view.toScreen(x, y);
    context.beginPath();
    context.arc(right, down, 11, 0, 2 * Math.PI);
    if (yaw !== null) {
      const angle = view.angle(yaw);
      context.moveTo(right, down);
      context.lineTo(right + 34 * Math.cos(angle), down + 34 * Math.sin(angle));
    } else {
      context.moveTo(right - 17, down);
      context.lineTo(right + 17, down);
      context.moveTo(right, down - 17);
      context.lineTo(right, down + 17);
    }
    this.stroke("halo", 6);
    this.stroke("target", 3);
  }

  /** A bar of a round length. */
  scaleBar() {
    const { context, view } = this;
    const length = [0.1, 0.2, 0.5, 1, 2, 5, 10].find((one) => one * view.scale >= 56) || 10;
    const [left, down] = [14, view.height - 16];
    context.beginPath();
    context.moveTo(left, down - 5);
    context.lineTo(left, down);
    context.lineTo(left + length * view.scale, down);
    context.lineTo(left + length * view.scale, down - 5);
    this.stroke("label", 2);
    Object.assign(context, { font: this.font, textAlign: "left", textBaseline: "bottom", fillStyle: this.colours.label });
    context.fillText(t("metres", { value: decimal(length, length < 1 ? 1 : 0) }), left + 5, down - 5);
  }
}

function middle(points) {
  const sum = points.reduce(([x, y], one) => [x + one[0], y + one[1]], [0, 0]);
  return [sum[0] / points.length, sum[1] / points.length];
}

/** The shorter side of a rectangle: walls are thin. */
function thickness(points) {
  const side = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  return points.length === 4 ? Math.min(side(points[0], points[1]), side(points[1], points[2])) : Infinity;
}
