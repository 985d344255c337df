/** The way that the robot has driven, as odometry measured it. A tab keeps it over a reload, as long as the server is the same. */

import { state } from "./connection.js";
import { keepInTab, takeFromTab } from "./dom.js";

const KEPT = "chatrobot-trail";
const LEAST_STEP_M = 0.02;
const MOST_POINTS = 6000;

/** The robot that a trail belongs to: a server that is begun anew has another port for Stop. */
const robot = () => `${state.hello.stop_port} ${state.hello.room}`;

export class Trail {
  constructor() {
    this.points = [];
    this.epoch = null;
    addEventListener("pagehide", () => {
      if (state.hello) keepInTab(KEPT, JSON.stringify({ robot: robot(), epoch: this.epoch, points: this.points }));
    });
  }

  /** Take back what the tab has kept of this robot. */
  restore() {
    const kept = JSON.parse(takeFromTab(KEPT) || "{}");
    if (kept.robot === robot()) Object.assign(this, { epoch: kept.epoch, points: kept.points });
  }

  /** Add where the robot is; odometry that begins anew has nothing to do with the way before. */
  note({ pose: { x_m: x, y_m: y }, odometry_epoch: epoch }) {
    if (this.epoch !== null && epoch !== this.epoch) this.points = [];
    this.epoch = epoch;
    const last = this.points[this.points.length - 1];
    if (!last || Math.hypot(x - last[0], y - last[1]) > LEAST_STEP_M) this.points.push([x, y]);
    if (this.points.length > MOST_POINTS) this.points.shift();
  }
}
