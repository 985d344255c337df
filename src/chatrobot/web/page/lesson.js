/** The lesson above the chat: the task that is to be done, what the last turn achieved, and the pupil's commands. */

import { on, send } from "./connection.js";
import { byId, make, makeButton, restButton, setText } from "./dom.js";
import { onLanguage, t } from "./words.js";

const COMMANDS = { "lesson_hint": "/hint", "lesson_again": "/again", "lesson_skip": "/skip" };

let over = false;
let count = 0;

const panel = byId("lesson");
const verdict = byId("lesson-verdict");

function show(message) {
  panel.hidden = false;
  byId("examples").hidden = true; // the task says what to do
  setText(byId("lesson-head"), message.head);
  const lines = [...message.about.map((line) => make("p", "hint", line)), ...message.lines.map((line) => make("p", "", line))];
  byId("lesson-lines").replaceChildren(...lines);
  showVerdict(message.verdict);
  ({ over, count } = message);
  showButtons();
}

function showVerdict(found) {
  verdict.dataset.state = found ? found.state : "";
  setText(verdict, found ? `${found.state === "passed" ? "✓" : "→"} ${found.text}` : "");
}

/** The commands of a task; at the end of the lesson the ways back to each. They stay the same ones while they say the same. */
function showButtons() {
  const back = () => Array.from({ length: count }, (_, at) => [t("lesson_back", { number: at + 1 }), `/task ${at + 1}`]);
  const wanted = over ? back() : Object.entries(COMMANDS).map(([word, text]) => [t(word), text]);
  const box = byId("lesson-buttons");
  if (wanted.map(([label]) => label).join() === [...box.children].map((one) => one.textContent).join()) return;
  box.replaceChildren(...wanted.map(([label, text]) => makeButton(label, "small", (event) => {
    if (send({ do: "say", text })) restButton(event.currentTarget); // a double click leaves out one task
  })));
}

/** Begin: hear what there is to show. */
export function startLesson() {
  on("lesson", show);
  on("open", () => {
    panel.hidden = true;
  });
  onLanguage(showButtons);
}
