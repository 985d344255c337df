/** Programs that are kept: their source with what is risky in it, their rehearsal, their log. */

import { on, send, state, tell } from "./connection.js";
import { byId, make, makeButton, setText } from "./dom.js";
import { notice } from "./steering.js";
import { decimal, onLanguage, t } from "./words.js";

const MOST_LOG_LINES = 200;

const list = byId("program-list");
const source = byId("program-source");
const text = byId("program-text");
const log = byId("program-log");

/** What a person typed and did not save, or what was refused, by the program's name. */
const drafts = new Map();
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
  edit(drafts.has(shown.name) && drafts.get(shown.name) !== shown.source);
  if (!state.isReplaying) byId("program").scrollIntoView({ block: "nearest" });
}

function edit(isOn) {
  text.hidden = byId("program-save").hidden = byId("program-drop").hidden = !isOn;
  source.hidden = byId("program-edit").hidden = byId("program-run").hidden = isOn;
  if (!isOn) return;
  text.value = drafts.get(shown.name) ?? shown.source;
  text.rows = Math.min(20, text.value.split("\n").length + 1);
}

/** Edit the program that is shown, where it is the one of that turn; false where it is not. */
export function editProgram(turn = runningTurn) {
  if (!shown || turn !== runningTurn) return false;
  edit(true);
  text.focus();
  return true;
}

function save() {
  if (!text.value.trim()) {
    notice(t("program_empty")); // nothing is rehearsed in its place
    return;
  }
  drafts.set(shown.name, text.value);
  if (!send({ do: "edit_program", name: shown.name, source: text.value })) return;
  notice("");
  edit(false);
  tell({ is: "asking" });
}

/** What is kept is shown again: the last version may have been refused. */
function drop() {
  drafts.delete(shown.name);
  edit(false);
  send({ do: "program", name: shown.name });
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
  rehearsed(event) {
    if (event.turn !== runningTurn || !event.ok || shown.source !== drafts.get(shown.name)) return;
    drafts.delete(shown.name);
    setText(byId("program-about"), `${byId("program-about").textContent} · ${t("program_edit_kept")}`);
  },
  program_log(event) {
    if (event.turn === runningTurn || !runningTurn) logLine(`${decimal(event.t_s, 1)} s  ${event.text}`, event.level);
  },
  started(event) {
    if (event.turn === runningTurn) logLine(t("program_started", { name: runs }), "rehearsed");
  },
  result(event) {
    if (event.turn !== runningTurn) return;
    logLine(event.reply, event.outcome === "failed" ? "error" : "");
    if (event.outcome === "refused" && shown.name === runs && drafts.has(runs)) edit(true);
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
  byId("program-edit").addEventListener("click", () => editProgram());
  byId("program-drop").addEventListener("click", drop);
  byId("program-save").addEventListener("click", save);
  text.addEventListener("input", () => drafts.set(shown.name, text.value));
  onLanguage(drawList);
}
