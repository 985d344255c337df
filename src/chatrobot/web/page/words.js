/** The page's own words, English and Chinese. Sentences about the robot come from the server, in the same language. */

const STORED = "chatrobot-language";
const CODES = ["en", "zh"];

let words = {};
let code = "en";
const listeners = [];

export function language() {
  return code;
}

/** The language to begin with: the one chosen last, else the browser's. */
export function firstLanguage() {
  const chosen = stored();
  return CODES.includes(chosen) ? chosen : browserLanguage();
}

function browserLanguage() {
  return navigator.language.toLowerCase().startsWith("zh") ? "zh" : "en";
}

/** The page's words for `key`, with `{name}` filled in. */
export function t(key, values = {}) {
  const text = words[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? values[name] : whole));
}

/** Have `listener` called whenever the language changed. */
export function onLanguage(listener) {
  listeners.push(listener);
}

/** Load the words of a language and put them on everything that has some. */
export async function setLanguage(wanted) {
  const answer = await fetch(`words.${wanted}.json`);
  words = await answer.json();
  code = wanted;
  store(wanted);
  document.documentElement.lang = wanted === "zh" ? "zh-Hans" : "en";
  for (const element of document.querySelectorAll("[data-t]")) element.textContent = t(element.dataset.t);
  for (const element of document.querySelectorAll("[data-t-label]")) {
    element.setAttribute("aria-label", t(element.dataset.tLabel));
    if (element.matches("button")) element.title = t(element.dataset.tLabel);
  }
  for (const element of document.querySelectorAll("[data-t-placeholder]")) {
    element.placeholder = t(element.dataset.tPlaceholder);
  }
  for (const listener of listeners) listener(wanted);
}

function stored() {
  try {
    return localStorage.getItem(STORED);
  } catch {
    return null; // a browser that keeps nothing
  }
}

function store(wanted) {
  try {
    localStorage.setItem(STORED, wanted);
  } catch {
    // a browser that keeps nothing asks for the language each time
  }
}
