/** The lesson above the chat: the task that is to be done, what the last turn achieved, and the pupil's commands. */

import { on, send } from "./connection.js";
import { byId, make, makeButton, restButton, setText } from "./dom.js";
import { onLanguage, t } from "./words.js";

const COMMANDS = { "lesson_hint": "/hint", "lesson_again": "/again", "lesson_skip": "/skip" };

const panel = byId("lesson");
const verdict = byId("lesson-verdict");

function show(message) {
  panel.hidden = false;
  byId("examples").hidden = true; // the task says what to do
  setText(byId("lesson-head"), message.head);
  const lines = [...message.about.map((line) => make("p", "hint", line)), ...message.lines.map((line) => make("p", "", line))];
  byId("lesson-lines").replaceChildren(...lines);
  byId("lesson-buttons").hidden = message.over;
}

function showVerdict(message) {
  verdict.dataset.state = message.state;
  setText(verdict, `${message.state === "passed" ? "✓" : "→"} ${message.text}`);
}

function showButtons() {
  const press = ([word, text]) => makeButton(t(word), "small", (event) => {
    if (send({ do: "say", text })) restButton(event.currentTarget); // a double click leaves out one task
  });
  byId("lesson-buttons").replaceChildren(...Object.entries(COMMANDS).map(press));
}

/** Begin: hear what there is to show. */
export function startLesson() {
  on("lesson", show);
  on("verdict", showVerdict);
  on("open", () => {
    panel.hidden = true;
    setText(verdict, "");
  });
  onLanguage(showButtons);
}
