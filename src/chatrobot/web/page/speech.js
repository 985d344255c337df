/** Speech: the browser turns what it hears into text, and reads replies aloud; both are off until a person asks. */

import { byId, isPressed, setPressed } from "./dom.js";
import { fillBox, sendBox } from "./say_box.js";
import { notice } from "./steering.js";
import { language, t } from "./words.js";

const CODES = { en: "en-US", zh: "zh-CN", de: "de-DE" };
const STOPS = /^\s*(stop|halt|anhalten|停|停下|停止|急停)/i;

const microphone = byId("microphone");
const note = byId("microphone-note");
const Recognition = window.SpeechRecognition || window.webkitSpeechRecognition;
let recognition = null;
let isAllowed = false;

/** Read a text aloud, where a person switched that on. */
export function speak(text, code) {
  if (!isPressed(byId("speak"))) return;
  const spoken = new SpeechSynthesisUtterance(text);
  spoken.lang = CODES[code];
  speechSynthesis.cancel();
  speechSynthesis.speak(spoken);
}

/** A text that was heard waits in the box for its person, who may see what was misheard; a stop does not wait. */
function hear(event) {
  const last = event.results[event.results.length - 1];
  const text = last[0].transcript.trim();
  fillBox(text);
  if (STOPS.test(text)) {
    sendBox();
    end();
  }
}

function begin() {
  note.hidden = true;
  isAllowed = true;
  recognition = new Recognition();
  recognition.lang = CODES[language()];
  recognition.interimResults = true;
  recognition.onresult = hear;
  recognition.onerror = (event) => event.error !== "aborted" && notice(t("microphone_failed", { why: event.error }));
  recognition.onend = end;
  recognition.start();
  setPressed(microphone, true);
}

function end() {
  setPressed(microphone, false);
  const ended = recognition;
  recognition = null;
  if (ended) ended.abort();
  byId("say").focus();
}

export function startSpeech() {
  microphone.hidden = !Recognition || !window.isSecureContext;
  microphone.addEventListener("click", () => {
    if (recognition) end();
    else if (isAllowed) begin();
    else {
      note.hidden = false;
      byId("microphone-yes").focus();
    }
  });
  byId("microphone-yes").addEventListener("click", begin);
  byId("microphone-no").addEventListener("click", () => {
    note.hidden = true;
    byId("say").focus();
  });
  byId("speak").hidden = !("speechSynthesis" in window);
  byId("speak").addEventListener("click", () => {
    setPressed(byId("speak"), !isPressed(byId("speak")));
    speechSynthesis.cancel();
  });
}
