/**
 * Pointing at the map. A tap sends the robot there; a drag moves the map, two fingers and the wheel zoom. With
 * "Set heading", with Shift, or after a long press, a drag says how the robot is to look there. Keys do the same.
 */

import { byId, isPressed, setPressed } from "./dom.js";
import { drag, drop, grab, isPutting, putAt } from "./map_obstacles.js";

const TAP_PX = 7;
const LONG_PRESS_MS = 450;
const WHEEL = 0.0015;
const STEP = 1.25;
const KEY_STEP_PX = 24;
const KEY_TURN_RAD = Math.PI / 12;

/** Begin. `known.target` is where a person points; `go` sends the robot there, and `enter` does so by a key. */
export function startPointing({ view, known, redraw, go, enter, release }) {
  const floor = byId("floor");
  const fingers = new Map();
  let start = null;
  let timer = 0;

  const at = (event) => {
    const box = floor.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  function point(place, yaw) {
    const [x, y] = view.toFloor(...place);
    known.target = { x, y, yaw };
    redraw();
  }

  function turnTo(place) {
    const [x, y] = view.toFloor(...place);
    const degrees = (Math.atan2(y - known.target.y, x - known.target.x) * 180) / Math.PI;
    known.target.yaw = (Math.round(degrees) * Math.PI) / 180; // a plan with round numbers reads better
    redraw();
  }

  function down(event) {
    if (event.button !== 0) return;
    floor.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    clearTimeout(timer);
    if (fingers.size > 1) {
      drop(false);
      start = null;
      return;
    }
    const place = at(event);
    if (grab(view.toFloor(...place))) {
      start = { place, isGrabbing: true, hasMoved: false };
      return;
    }
    start = { place, isAiming: !isPutting() && (isPressed(byId("heading")) || event.shiftKey), hasMoved: false };
    if (start.isAiming) point(place, null);
    else if (!isPutting()) timer = setTimeout(() => {
      if (!start || start.hasMoved) return;
      start.isAiming = true;
      point(place, null);
    }, LONG_PRESS_MS);
  }

  function pinch(event, place) {
    const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, one]) => one);
    const before = fingers.get(event.pointerId);
    const far = (one) => Math.max(1, Math.hypot(one[0] - other[0], one[1] - other[1]));
    view.zoom(far(place) / far(before), (place[0] + other[0]) / 2, (place[1] + other[1]) / 2);
    view.pan((place[0] - before[0]) / 2, (place[1] - before[1]) / 2);
    redraw();
  }

  function move(event) {
    if (!fingers.has(event.pointerId)) return;
    const place = at(event);
    if (fingers.size > 1) pinch(event, place);
    else if (start) {
      const before = fingers.get(event.pointerId);
      start.hasMoved ||= Math.hypot(place[0] - start.place[0], place[1] - start.place[1]) > TAP_PX;
      if (start.isGrabbing) {
        drag(view.toFloor(...place));
        redraw();
      } else if (start.hasMoved && start.isAiming) turnTo(place);
      else if (start.hasMoved) {
        release();
        view.pan(place[0] - before[0], place[1] - before[1]);
        redraw();
      }
    }
    fingers.set(event.pointerId, place);
  }

  function up(event) {
    clearTimeout(timer);
    if (!fingers.delete(event.pointerId) || !start) return;
    drop(start.hasMoved);
    if (!start.hasMoved && isPutting()) {
      known.target = null;
      putAt(view.toFloor(...start.place));
    } else if (start.isGrabbing) redraw();
    else if (start.isAiming) {
      setPressed(byId("heading"), false);
      go();
    } else if (!start.hasMoved) {
      point(start.place, null);
      go();
    }
    start = null;
  }

  function cancel(event) {
    clearTimeout(timer);
    fingers.delete(event.pointerId);
    drop(false);
    if (start && start.isAiming) known.target = null;
    start = null;
    redraw();
  }

  function wheel(event) {
    event.preventDefault();
    view.zoom(Math.exp(-event.deltaY * WHEEL), ...at(event));
    redraw();
  }

  function keyPoint(right, down, isTurn) {
    if (!known.target) {
      const pose = known.pose || { x_m: 0, y_m: 0 };
      known.target = { x: pose.x_m, y: pose.y_m, yaw: null };
    }
    const target = known.target;
    if (isTurn) target.yaw = (target.yaw ?? (known.pose ? known.pose.yaw_rad : 0)) - Math.sign(right || down) * KEY_TURN_RAD;
    else {
      const [x, y] = view.toScreen(target.x, target.y);
      [target.x, target.y] = view.toFloor(x + right * KEY_STEP_PX, y + down * KEY_STEP_PX);
    }
    redraw();
  }

  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  function key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key in arrows) keyPoint(...arrows[event.key], event.shiftKey);
    else if (event.key === "Enter" && isPutting() && known.target) {
      putAt([known.target.x, known.target.y]);
      known.target = null;
    } else if (event.key === "Enter") event.repeat || enter();
    else if (event.key === "+" || event.key === "=") zoom(STEP);
    else if (event.key === "-") zoom(1 / STEP);
    else if (event.key === "Backspace" || event.key === "Delete") known.target = null;
    else return;
    event.preventDefault();
    redraw();
  }

  function zoom(factor) {
    view.zoom(factor);
    redraw();
  }

  floor.addEventListener("pointerdown", down);
  floor.addEventListener("pointermove", move);
  floor.addEventListener("pointerup", up);
  floor.addEventListener("pointercancel", cancel);
  floor.addEventListener("wheel", wheel, { passive: false });
  floor.addEventListener("keydown", key);
  floor.addEventListener("contextmenu", (event) => event.preventDefault());
  byId("heading").addEventListener("click", (event) => setPressed(event.target, !isPressed(event.target)));
  byId("zoom-in").addEventListener("click", () => zoom(STEP));
  byId("zoom-out").addEventListener("click", () => zoom(1 / STEP));
}
