/**
 * STOP: the shortest way from a finger to the robot. A second WebSocket, to a thread that does nothing else, stays open;
 * the word goes out there and on the first one before anything else is done. Loaded first, imports next to nothing.
 */

import { byId, isTextField } from "./dom.js";

const SENT = { stop: '{"do":"stop"}', emergency_stop: '{"do":"emergency_stop"}' };
const OPEN = 1;
const AGAIN_MS = 500;

let firstLine = null;
let stopLine = null;
let stopAddress = "";
let hear = () => {};

/** Send the word on every line that is open; then tell the page. */
function stop(what) {
  const word = SENT[what];
  let lines = 0;
  for (const line of [stopLine, firstLine]) {
    if (line && line.readyState === OPEN) {
      line.send(word);
      lines += 1;
    }
  }
  hear({ is: lines ? "asked" : "unheard", do: what });
}

/** Have everything that is said of a stop told to `listener`: `asked`, `unheard`, `stopped`, `gone`, `line`. */
export function onStop(listener) {
  hear = listener;
}

/** The first WebSocket, on which STOP goes as well. */
export function useFirstLine(socket) {
  firstLine = socket;
}

/** Open the second WebSocket and keep it open; "" closes it. */
export function useStopLine(address) {
  if (address === stopAddress && stopLine && stopLine.readyState <= OPEN) return;
  stopAddress = address;
  if (stopLine) stopLine.close();
  stopLine = null;
  if (address) open();
}

export function isStopLineOpen() {
  return Boolean(stopLine) && stopLine.readyState === OPEN;
}

function open() {
  const line = new WebSocket(stopAddress);
  stopLine = line;
  line.onopen = () => hear({ is: "line" });
  line.onmessage = (message) => hear(JSON.parse(message.data));
  line.onclose = () => {
    if (line !== stopLine) return;
    hear({ is: "line" });
    setTimeout(() => line === stopLine && stopAddress && open(), AGAIN_MS);
  };
}

/** The word goes out when the finger comes down, not when it leaves; a click without a finger is a key or a reader. */
function stopWith(button, what) {
  let isDown = false;
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    stop(what);
    isDown = true;
  });
  button.addEventListener("click", () => {
    if (!isDown) stop(what);
    isDown = false;
  });
}

function isStopKey(event) {
  if (event.key === "Escape") return true;
  if (event.code !== "Space" || event.isComposing || event.ctrlKey || event.altKey || event.metaKey) return false;
  const field = event.target;
  return !isTextField(field) || (field.id === "say" && field.value === "" && event.keyCode !== 229);
}

addEventListener("keydown", (event) => {
  if (!isStopKey(event)) return;
  if (!event.repeat) stop("stop");
  event.preventDefault();
}, true);
// Where a browser presses the button that has the focus when the space bar comes up.
addEventListener("keyup", (event) => {
  if (event.code === "Space" && !isTextField(event.target)) event.preventDefault();
}, true);
stopWith(byId("stop"), "stop");
stopWith(byId("emergency"), "emergency_stop");
