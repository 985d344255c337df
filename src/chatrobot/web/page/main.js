/** The page begins here. */

import { startCamera } from "./camera.js";
import { onEditPlan, startChat } from "./chat.js";
import { connect, on, replay, send, state } from "./connection.js";
import { byId, startMenus } from "./dom.js";
import { startGauges } from "./gauges.js";
import { startLesson } from "./lesson.js";
import { asksBeforeTaps, startMap } from "./map.js";
import { startPlaces } from "./places.js";
import { editPlan, startPlan } from "./plan.js";
import { editProgram, startPrograms } from "./programs.js";
import { startSayBox } from "./say_box.js";
import { startSpeech } from "./speech.js";
import { startSteering } from "./steering.js";
import { startStick } from "./stick.js";
import { firstLanguage, language, onLanguage, setLanguage, startLanguageMenu } from "./words.js";

/** On a narrow screen one panel is seen at a time, under the map. */
function showTab(name) {
  document.body.dataset.tab = name;
  for (const button of document.querySelectorAll(".tabs button")) {
    if (button.dataset.tab === name) button.setAttribute("aria-current", "true");
    else button.removeAttribute("aria-current");
  }
}

function startLanguage() {
  startLanguageMenu();
  onLanguage((code) => {
    if (send({ do: "language", code })) send({ do: "history" });
  });
  on("open", () => {
    send({ do: "language", code: language() });
    if (language() !== state.hello.language) send({ do: "history" }); // it took the browser to speak another
  });
}

startSteering();
startSayBox();
startChat();
startLesson();
startPlan();
startMap();
startPlaces(asksBeforeTaps);
startGauges();
startCamera();
startPrograms();
startStick();
startSpeech();
startLanguage();
startMenus();
onEditPlan((turn) => {
  const isProgram = editProgram(turn);
  showTab(isProgram ? "programs" : "plan");
  if (!isProgram) editPlan();
});
for (const button of document.querySelectorAll(".tabs button")) {
  button.addEventListener("click", () => showTab(button.dataset.tab));
}
showTab("chat");
on("asking", () => showTab("chat")); // what was pointed at is asked about there
// What was told before we came, once everybody listens.
on("open", () => replay(state.hello.history));
on("history", (message) => replay(message.history));
await setLanguage(firstLanguage());
connect();
if (matchMedia("(pointer: fine)").matches) byId("say").focus();
