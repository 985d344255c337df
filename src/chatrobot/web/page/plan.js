/** The plan as lines: the one that runs is marked, and all of them can be edited. */

import { on, send, state } from "./connection.js";
import { byId, make, setText } from "./dom.js";
import { notice } from "./steering.js";
import { onLanguage, t } from "./words.js";

const lines = byId("plan-lines");
const text = byId("plan-text");
const about = byId("plan-about");

const plan = {
  turn: 0, lines: [], step: 0, outcome: "", waits: false, streams: false, isEdited: false, edits: 0, isProgram: false, isSent: false, isPaused: false,
};
/** How the last plan ended, where it was not done. */
const ENDS = { stopped: "plan_stopped", refused: "plan_refused", failed: "plan_failed", unclear: "plan_unclear" };

const NUMBER_OR_QUOTED = /"(?:[^"\\]|\\.)*"|-?\d+\.\d{4,}(?:e[-+]?\d+)?/g;

/** A line with numbers to three decimals; what runs or is edited is the exact text, never this. */
function shown(line) {
  return line.replace(NUMBER_OR_QUOTED, (found) => (found.startsWith('"') ? found : String(+Number(found).toFixed(3))));
}

/** The lines of a plan by its steps: a repeat is one step with all its lines. */
function stepsOfLines(all) {
  let step = 0;
  let depth = 0;
  return all.map((line) => {
    const word = line.trim();
    if (word === "end") depth -= 1;
    else {
      if (depth === 0) step += 1;
      if (word.startsWith("repeat ")) depth += 1;
    }
    return step;
  });
}

function draw() {
  const steps = stepsOfLines(plan.lines);
  lines.replaceChildren(...plan.lines.map((line, at) => {
    const item = make("li", "", shown(line));
    const isRunning = plan.step > 0 && steps[at] === plan.step && !plan.outcome;
    item.classList.toggle("running", isRunning);
    item.classList.toggle("left", plan.outcome in ENDS && steps[at] === plan.step);
    item.classList.toggle("done", plan.step > steps[at] || plan.outcome === "completed");
    if (isRunning) item.setAttribute("aria-current", "step");
    return item;
  }));
  lines.classList.toggle("paused", plan.isPaused);
  const running = lines.querySelector(".running");
  if (running) lines.scrollTop = running.offsetTop - lines.clientHeight / 2;
  describe();
}

function stateOfLines() {
  if (plan.waits) return "plan_waits";
  if (plan.outcome) return ENDS[plan.outcome] ?? "plan_last";
  if (plan.isPaused) return "paused";
  return plan.step ? "plan_runs" : "plan_last";
}

function describe() {
  let key = "plan_none";
  if (plan.isProgram) key = "plan_program";
  if (plan.lines.length) key = stateOfLines();
  if (!state.isOpen && (plan.waits || (plan.step && !plan.outcome))) key = "plan_unknown";
  if (plan.isEdited) key = "plan_help";
  setText(about, t(key));
  about.classList.toggle("undone", Object.values(ENDS).includes(key));
  byId("plan-run").hidden = !plan.isEdited && !plan.waits;
  setText(byId("plan-run"), t(plan.isEdited ? "plan_try" : "do_it"));
  setText(byId("plan-edit"), t(plan.lines.length ? "edit" : "plan_write"));
  byId("plan-edit").hidden = plan.isEdited || (plan.waits && plan.isProgram); // a program has its own editor
  byId("plan-drop").hidden = !plan.isEdited && !plan.waits;
  setText(byId("plan-drop"), t(plan.isEdited ? "edit_drop" : "cancel"));
  lines.hidden = plan.isEdited || !plan.lines.length;
  text.hidden = !plan.isEdited;
}

/** Begin to edit the plan that is shown. */
export function editPlan() {
  plan.isEdited = true;
  plan.edits = plan.waits ? plan.turn : 0;
  text.value = plan.lines.join("\n");
  text.rows = Math.max(4, Math.min(14, plan.lines.length + 1));
  describe();
  text.focus();
}

function run() {
  const planText = text.value.trim();
  let message = { do: "approve", turn: plan.turn, yes: true };
  if (plan.isEdited) {
    if (!planText) {
      notice(t("plan_empty"));
      return;
    }
    message = plan.edits ? { do: "edit", plan_text: planText, turn: plan.edits } : { do: "say_plan", plan_text: planText };
  }
  if (!send(message)) return;
  notice("");
  if (plan.isEdited) show(0, planText.split("\n")); // one that cannot be read can be mended
  plan.isSent = plan.isEdited;
  plan.isEdited = plan.waits = false;
  draw();
}

function drop() {
  if (!plan.isEdited) send({ do: "approve", turn: plan.turn, yes: false });
  plan.isEdited = false;
  describe();
}

function show(turn, planLines) {
  Object.assign(plan, { turn, lines: planLines, step: 0, outcome: "", waits: false, isProgram: false, isPaused: false });
}

const heard = {
  notice(event) {
    if (event.reason.code !== "edit_unreadable" || !plan.isSent) return false;
    // What waits now is the version before it: its edit stays open, or a yes would mean what is not seen.
    Object.assign(plan, { isEdited: true, edits: event.turn, isSent: false });
    return true;
  },
  streamed(event) {
    if (event.turn !== plan.turn || !plan.streams) show(event.turn, []);
    plan.streams = true;
    plan.lines.push(...event.plan_text.split("\n"));
  },
  ordered(event) {
    if (event.rehearse_only) return;
    show(event.turn, event.plan_text.split("\n").filter(Boolean));
    plan.isProgram = Boolean(event.program);
  },
  interpreted(event) {
    plan.streams = plan.isSent = false;
    if (!event.plan_text) return;
    const step = event.turn === plan.turn ? plan.step : 0;
    show(event.turn, event.plan_text.split("\n"));
    plan.step = step;
  },
  program_written(event) {
    show(event.turn, []);
    plan.isProgram = true;
  },
  rehearsed(event) {
    if (event.turn === plan.turn) plan.waits = event.needs_approval;
  },
  started(event) {
    if (event.turn === plan.turn) Object.assign(plan, { waits: false, step: 1, outcome: "", isPaused: false });
  },
  paused(event) {
    if (event.turn === plan.turn) plan.isPaused = true;
  },
  progress(event) {
    if (event.turn !== plan.turn || event.step === plan.step) return false;
    plan.step = event.step;
    return true;
  },
  result(event) {
    if (event.turn === plan.turn) Object.assign(plan, { waits: false, outcome: event.outcome, isPaused: false });
  },
};

heard.finished = heard.result;

export function startPlan() {
  on("closed", describe);
  on("open", () => {
    show(0, []);
    draw();
  });
  on("said", ({ turn, text: said }) => {
    if (plan.isSent && !plan.turn && said === plan.lines.join("\n")) plan.turn = turn; // its end is told even where it cannot be read
  });
  on("event", ({ event }) => {
    const hear = heard[event.event];
    if (hear && hear(event) !== false) draw();
  });
  byId("plan-edit").addEventListener("click", editPlan);
  byId("plan-run").addEventListener("click", run);
  byId("plan-drop").addEventListener("click", drop);
  onLanguage(describe);
}
