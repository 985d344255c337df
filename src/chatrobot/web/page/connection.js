/** The connection to the server: opened, kept, opened again; messages out, messages in by their kind. */

import { keepInTab, takeFromTab } from "./dom.js";
import { useFirstLine, useStopLine } from "./stop.js";

const OPEN = 1;
const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 4000;
const STALE_MS = 800;
const SILENCE_MS = 3000;
const LOOK_MS = 200;
const GUESSED = 429;
const GUESSED_WAIT_MS = 61000;
const REFUSALS = [401, 403, 404, 421, GUESSED];

/** Kept in the tab where the page loads itself again for a server that was begun anew. */
export const BEGUN_ANEW = "chatrobot-begun-anew";

const listeners = new Map();
let query = location.search;
let path = "/ws";
let socket = null;
let waitMs = FIRST_WAIT_MS;
let timer = 0;
let heardMs = 0;
let hadTelemetry = false;
let stopPort = 0;

/** What the page knows of itself: from `hello`, kept up to date. */
export const state = {
  isOpen: false,
  isSilent: false,
  hello: null,
  mine: new Set(),
  steers: false,
  may: new Set(),
  isReplaying: false,
};

/** Have `listener` hear messages of that kind; kinds of our own are `open`, `closed`, `denied`, `silence`, `still` and `asking`. */
export function on(kind, listener) {
  if (!listeners.has(kind)) listeners.set(kind, []);
  listeners.get(kind).push(listener);
}

export function tell(message) {
  for (const listener of listeners.get(message.is) || []) listener(message);
}

/** Hear what was told earlier, through the same listeners. */
export function replay(messages) {
  state.isReplaying = true;
  for (const message of messages) tell(message);
  state.isReplaying = false;
}

/** Send a message; false where the connection is gone. */
export function send(message) {
  if (!socket || socket.readyState !== OPEN) return false;
  socket.send(JSON.stringify(message));
  return true;
}

function addressOf(port, path) {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const host = port ? `${location.hostname}:${port}` : location.host;
  return `${scheme}://${host}${path}${query}`;
}

/** Come in: with the token of the link where it has one, then with the cookie. A teacher's page has a path of its own. */
export async function connect(wanted = "/ws") {
  path = wanted;
  const token = decodeURIComponent(location.hash.slice(1)).replace(/^token=/, "");
  if (token) {
    const body = JSON.stringify({ token });
    const headers = { "Content-Type": "application/json" };
    const answer = await fetch("enter", { method: "POST", headers, body }).catch(() => null);
    if (answer && answer.ok) sitDown((await answer.json()).seat);
    history.replaceState(null, "", location.pathname + query);
  }
  open();
}

/** Several links may be open in one browser: a tab keeps, in its address, whose cookie is its own. */
function sitDown(seat) {
  const asked = new URLSearchParams(query);
  asked.delete("as");
  if (seat) asked.set("as", seat);
  query = asked.size ? `?${asked}` : "";
}

function open() {
  clearTimeout(timer);
  socket = new WebSocket(addressOf(0, path));
  const mine = socket;
  mine.onopen = () => {
    waitMs = FIRST_WAIT_MS;
    hadTelemetry = false;
    useFirstLine(mine);
  };
  mine.onmessage = (message) => hear(JSON.parse(message.data));
  mine.onclose = () => mine === socket && lose();
}

function hear(message) {
  heardMs = performance.now();
  noteSilence(false);
  if (message.is === "hello") greet(message);
  if (message.is === "steering") follow(message);
  if (message.is === "event" && message.event.event === "telemetry") hadTelemetry = true;
  tell(message);
}

/** The policy of a page names the port of Stop that it was loaded with: a server begun anew has another, and a page of its own. */
function isOfAnotherServer(hello) {
  const was = stopPort;
  stopPort = hello.stop_port || was;
  return was !== 0 && was !== stopPort;
}

/** Whom this tab has been at this server: a page that is loaded again is another to it, and its texts are still one's own. */
function rememberMe(hello) {
  const key = "chatrobot-was";
  const [port, ...before] = takeFromTab(key).split(" ");
  const ids = Number(port) === hello.stop_port ? before : [];
  state.mine = new Set([...ids, String(hello.you)]);
  keepInTab(key, [hello.stop_port, ...state.mine].join(" "));
}

function greet(hello) {
  if (isOfAnotherServer(hello)) {
    keepInTab(BEGUN_ANEW, "yes");
    location.reload();
    return;
  }
  state.isOpen = true;
  state.hello = hello;
  rememberMe(hello);
  follow({ by: hello.steering && hello.steering.by, may: hello.may });
  if (hello.stop_port) useStopLine(addressOf(hello.stop_port, "/stop"));
  tell({ is: "open" });
}

function follow(steering) {
  state.steers = Boolean(steering.by) && steering.by === state.hello.you;
  if (steering.may) state.may = new Set(steering.may);
}

/** What was told last is not known to be so any more, though the connection is still there. */
function noteSilence(isSilent) {
  if (state.isSilent === isSilent) return;
  state.isSilent = isSilent;
  tell({ is: "silence" });
}

function lose() {
  const was = state.isOpen;
  noteSilence(false);
  state.isOpen = state.steers = false;
  useFirstLine(null);
  useStopLine("");
  tell({ is: "closed", was });
  timer = setTimeout(open, waitMs);
  waitMs = Math.min(2 * waitMs, LONGEST_WAIT_MS);
  ask();
}

/** Ask why we are not let in: a WebSocket does not say. */
async function ask() {
  const answer = await fetch(`me${query}`, { cache: "no-store" }).catch(() => null);
  if (!answer) return;
  const status = answer.ok && path === "/class" ? await askRole(answer) : answer.status;
  if (!REFUSALS.includes(status)) return;
  clearTimeout(timer); // asked again and again it would count as guessing, for everybody at this address
  if (status === GUESSED) timer = setTimeout(open, GUESSED_WAIT_MS);
  tell({ is: "denied", status });
}

/** A pupil may come in, but not to the teacher's page. */
async function askRole(answer) {
  const me = await answer.json().catch(() => ({ role: "teacher" }));
  return me.role === "teacher" ? 200 : 403;
}

/** Close a connection on which nothing comes any more: a network that is gone closes none by itself. */
setInterval(() => {
  if (!state.isOpen || !hadTelemetry) return;
  const silentMs = performance.now() - heardMs;
  noteSilence(silentMs > STALE_MS);
  if (silentMs < SILENCE_MS) return;
  const silent = socket;
  socket = null;
  silent.close();
  lose();
}, LOOK_MS);
// Another link pasted into this tab changes the fragment alone, which loads nothing by itself.
addEventListener("hashchange", () => location.hash.length > 1 && location.reload());
addEventListener("online", () => {
  if (!state.isOpen && socket && socket.readyState > OPEN) open();
});
