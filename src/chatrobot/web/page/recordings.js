/** The recordings of a class on the teacher's page: listed, fetched, deleted at the second press, begun anew. */

import { send } from "./connection.js";
import { byId, make, makeButton, setChanging, setText } from "./dom.js";
import { decimal, language, onLanguage, t } from "./words.js";

const LOOK_MS = 3000;
const REALLY_MS = 4000;
const ALL = "";

const panel = byId("recordings");
const list = byId("recording-list");
const rows = new Map();
let known = null;
let asked = null;
let timer = 0;
let tellNotice = () => {};

/** Ask for the list, or have something deleted, which is answered by the list, too. */
async function ask(method = "GET", name = "") {
  const answer = await fetch(`recordings${name && `/${encodeURIComponent(name)}`}`, { method, cache: "no-store" }).catch(() => null);
  if (!answer) return;
  const told = await answer.json().catch(() => ({}));
  if (answer.ok) known = told;
  else if (told.text) tellNotice(told.text);
  draw();
}

/** Nothing is deleted by a finger that slips. */
function deleteAfterAsking(name) {
  clearTimeout(timer);
  if (asked !== name) {
    asked = name;
    timer = setTimeout(() => {
      asked = null;
      draw();
    }, REALLY_MS);
  } else {
    asked = null;
    ask("DELETE", name);
  }
  draw();
}

function sizeOf(bytes) {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${decimal(bytes / 1e6, 1)} MB`;
}

/** Fetch a file and have the browser save it; a report takes a moment to be made, and its maker may say why not. */
async function save(name, link) {
  if (link.getAttribute("aria-busy") === "true") return;
  link.setAttribute("aria-busy", "true");
  tellNotice(t("recording_made", { name }));
  const answer = await fetch(`recordings/${encodeURIComponent(name)}?language=${language()}`, { cache: "no-store" }).catch(() => null);
  link.removeAttribute("aria-busy");
  if (!answer || !answer.ok) {
    const told = answer ? await answer.json().catch(() => ({})) : {};
    tellNotice(told.text || t("no_connection"));
    return;
  }
  const saved = make("a");
  saved.href = URL.createObjectURL(await answer.blob());
  saved.download = name;
  saved.click();
  setTimeout(() => URL.revokeObjectURL(saved.href), REALLY_MS);
  tellNotice(t("recording_saved", { name }));
}

function makeRow(name) {
  const row = {
    text: make("span"),
    fetch: makeButton("", "small", () => save(name, row.fetch)),
    report: makeButton("", "small", () => save(name.replace(/mcap$/, "html"), row.report)),
    remove: makeButton("", "small", () => deleteAfterAsking(name)),
  };
  row.item = make("li", "", row.text, make("span", "space"), row.fetch, row.report, row.remove);
  rows.set(name, row);
  return row;
}

/** A file's row stays the same one: a press has begun on it, or the focus is there, while it is drawn anew. */
function rowOf(file) {
  const row = rows.get(file.name) || makeRow(file.name);
  const pupil = t("pupil", { name: file.pupil });
  const values = { name: pupil, time: file.name.slice(11, 19).replaceAll("-", ":"), size: sizeOf(file.size_bytes) };
  setText(row.text, t(file.written ? "recording_written" : "recording_whole", values));
  const word = asked === file.name ? "recording_delete_really" : "recording_delete";
  setText(row.fetch, t("recording_download"));
  setText(row.report, t("recording_report"));
  setChanging(row.remove, t(word), t("recording_delete_really"));
  for (const one of [row.fetch, row.report, row.remove]) {
    one.setAttribute("aria-label", `${one.textContent}: ${pupil}, ${values.time}`);
  }
  return row.item;
}

function drawList(files) {
  for (const [name, row] of rows) {
    if (files.some((file) => file.name === name)) continue;
    if (row.item.contains(document.activeElement)) byId("recordings-head").focus(); // keys go on from there
    row.item.remove();
    rows.delete(name);
  }
  files.map(rowOf).forEach((item, at) => list.children[at] !== item && list.insertBefore(item, list.children[at] ?? null));
}

function draw() {
  if (!known) return;
  panel.hidden = false;
  const { files, unrecorded, folder } = known;
  const size = sizeOf(files.reduce((sum, file) => sum + file.size_bytes, 0));
  setText(byId("recordings-head"), t("recordings_title", { count: files.length, size }));
  const missing = unrecorded.length ? t("recordings_unrecorded", { names: unrecorded.join(", ") }) : "";
  setText(byId("recordings-about"), `${t("recordings_about", { folder })} ${missing}`);
  byId("recordings-record").hidden = !unrecorded.length;
  byId("recordings-delete").hidden = !files.length;
  const word = asked === ALL ? "recordings_delete_really" : "recordings_delete";
  setChanging(byId("recordings-delete"), t(word), t("recordings_delete_really"));
  if (!panel.open) return;
  drawList(files);
}

/** Show them: the class is recorded. */
export function showRecordings() {
  ask();
}

export function startRecordings(notice) {
  tellNotice = notice;
  panel.addEventListener("toggle", () => ask());
  setInterval(() => panel.open && !asked && !document.hidden && ask(), LOOK_MS);
  byId("recordings-delete").addEventListener("click", () => deleteAfterAsking(ALL));
  byId("recordings-record").addEventListener("click", () => {
    for (const room of known.unrecorded) send({ do: "record", room });
    setTimeout(ask, LOOK_MS / 10);
  });
  onLanguage(draw);
}
