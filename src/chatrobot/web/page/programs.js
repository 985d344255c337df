/** Programs that are kept: their source with what is risky in it, their rehearsal, their log. */

import { on, send, state } from "./connection.js";
import { byId, make, makeButton, setText } from "./dom.js";
import { onLanguage, t } from "./words.js";

const MOST_LOG_LINES = 200;

const list = byId("program-list");
const source = byId("program-source");
const text = byId("program-text");
const log = byId("program-log");

let all = [];
let shown = null;
let runs = "";
let runningTurn = 0;

function drawList() {
  byId("programs-empty").hidden = all.length > 0;
  list.replaceChildren(...all.map((program) => {
    const open = makeButton(program.name, "small quiet", () => send({ do: "program", name: program.name }));
    if (program.description) open.title = program.description;
    const run = makeButton(t("program_run"), "small", () => send({ do: "run_program", name: program.name }));
    run.setAttribute("aria-label", t("program_run_named", { name: program.name }));
    run.disabled = !state.steers;
    return make("li", "", open, run);
  }));
}

/** Show a program; `marks` are `{line, severity, text}`. */
function show(program) {
  shown = program;
  byId("programs").hidden = byId("program").hidden = false;
  setText(byId("program-name"), program.name);
  setText(byId("program-about"), program.about || program.description || "");
  const marks = new Map();
  for (const mark of program.marks) marks.set(mark.line, [...(marks.get(mark.line) || []), mark]);
  source.replaceChildren(...program.source.replace(/\n$/, "").split("\n").map((line, at) => {
    const item = make("li", "", line || " ");
    for (const mark of marks.get(at + 1) || []) {
      item.classList.add("marked");
      item.append(make("em", mark.severity, mark.text));
    }
    return item;
  }));
  edit(false);
  if (!state.isReplaying) byId("program").scrollIntoView({ block: "nearest" });
}

function edit(isOn) {
  text.hidden = byId("program-save").hidden = byId("program-drop").hidden = !isOn;
  source.hidden = byId("program-edit").hidden = byId("program-run").hidden = isOn;
  if (!isOn) return;
  text.value = shown.source;
  text.rows = Math.min(20, shown.source.split("\n").length + 1);
  text.focus();
}

function logLine(line, level = "") {
  const box = log.parentElement;
  const isAtEnd = box.scrollHeight - box.scrollTop - box.clientHeight < 40;
  log.append(make("li", level.toLowerCase(), line));
  while (log.children.length > MOST_LOG_LINES) log.firstElementChild.remove();
  if (isAtEnd) box.scrollTop = box.scrollHeight;
}

const heard = {
  program_written(event, texts) {
    const marks = event.marks.map((mark, at) => ({
      line: mark.step[0] || 0, severity: mark.severity, text: [].concat(texts || [])[at] || mark.reason.code,
    }));
    show({ name: event.program, description: event.description, source: event.source, marks });
    log.replaceChildren();
    runs = event.program;
    runningTurn = event.turn;
    if (!state.isReplaying) send({ do: "programs" });
  },
  program_rehearsed(event, text) {
    if (text) setText(byId("program-about"), [].concat(text).join(" "));
    for (const line of event.log) logLine(line, "rehearsed");
    if (event.problem) logLine(event.problem, "error");
    const at = event.line ? source.children[event.line - 1] : null;
    if (at) at.classList.add("marked");
  },
  program_log(event) {
    if (event.turn === runningTurn || !runningTurn) logLine(`${event.t_s.toFixed(1)} s  ${event.text}`, event.level);
  },
  started(event) {
    if (event.turn === runningTurn) logLine(t("program_started", { name: runs }), "rehearsed");
  },
  result(event) {
    if (event.turn === runningTurn) logLine(event.reply, event.outcome === "failed" ? "error" : "");
  },
};

export function startPrograms() {
  on("open", () => {
    byId("programs").hidden = state.hello.programs === false;
    if (state.hello.programs !== false) send({ do: "programs" });
  });
  on("programs", (message) => {
    all = message.programs;
    drawList();
  });
  on("program", show);
  on("event", ({ event, text: words }) => heard[event.event] && heard[event.event](event, words));
  on("steering", drawList);
  byId("program-run").addEventListener("click", () => send({ do: "run_program", name: shown.name }));
  byId("program-edit").addEventListener("click", () => edit(true));
  byId("program-drop").addEventListener("click", () => edit(false));
  byId("program-save").addEventListener("click", () => {
    if (send({ do: "edit_program", name: shown.name, source: text.value })) edit(false);
  });
  onLanguage(drawList);
}
