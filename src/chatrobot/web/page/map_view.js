/** Where the floor is on the screen: metres to pixels and back. The world's own axes lie along the screen's. */

const LEAST_SCALE = 8;
const MOST_SCALE = 600;

export class View {
  constructor() {
    this.width = this.height = 1;
    this.scale = 70; // pixels a metre
    this.x = this.y = 0; // the point of the world in the middle
    this.isMoved = false; // by a person, since all was shown
    this.turn(0);
  }

  /** Set how the frame of the start lies in the world's own axes. */
  turn(yaw) {
    this.yaw = yaw;
    this.cos = Math.cos(yaw);
    this.sin = Math.sin(yaw);
  }

  toScreen(x, y) {
    const across = this.cos * x - this.sin * y - this.x;
    const up = this.sin * x + this.cos * y - this.y;
    return [this.width / 2 + across * this.scale, this.height / 2 - up * this.scale];
  }

  toFloor(screenX, screenY) {
    const across = (screenX - this.width / 2) / this.scale + this.x;
    const up = (this.height / 2 - screenY) / this.scale + this.y;
    return [this.cos * across + this.sin * up, -this.sin * across + this.cos * up];
  }

  /** Whether a point of the floor can be seen. */
  shows(x, y) {
    const [screenX, screenY] = this.toScreen(x, y);
    return screenX >= 0 && screenX <= this.width && screenY >= 0 && screenY <= this.height;
  }

  /** Return the angle on the screen, clockwise, of a heading on the floor. */
  angle(yaw) {
    return -(yaw + this.yaw);
  }

  /** Keep the point of the floor under these pixels there, and make the floor larger by `factor`. */
  zoom(factor, screenX = this.width / 2, screenY = this.height / 2) {
    const scale = Math.max(LEAST_SCALE, Math.min(MOST_SCALE, this.scale * factor));
    const [right, up] = [screenX - this.width / 2, this.height / 2 - screenY];
    this.x += right / this.scale - right / scale;
    this.y += up / this.scale - up / scale;
    this.scale = scale;
    this.isMoved = true;
  }

  pan(rightPx, downPx) {
    this.isMoved = true;
    this.x -= rightPx / this.scale;
    this.y += downPx / this.scale;
  }

  /** Have a point of the floor in the middle. */
  centre(x, y) {
    this.x = this.cos * x - this.sin * y;
    this.y = this.sin * x + this.cos * y;
  }

  /** Show all these points of the floor, within `inset` pixels of each edge: there are buttons and the scale bar. */
  fit(points, { top, right: end, bottom, left: begin }) {
    const turned = points.map(([x, y]) => [this.cos * x - this.sin * y, this.sin * x + this.cos * y]);
    const [xs, ys] = [turned.map((one) => one[0]), turned.map((one) => one[1])];
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const across = (this.width - begin - end) / Math.max(right - left, 1);
    const up = (this.height - top - bottom) / Math.max(high - low, 1);
    this.scale = Math.max(LEAST_SCALE, Math.min(MOST_SCALE, across, up));
    this.x = (left + right + (end - begin) / this.scale) / 2;
    this.y = (low + high + (top - bottom) / this.scale) / 2;
    this.isMoved = false;
  }
}
