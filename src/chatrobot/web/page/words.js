/** The page's own words, a file for each language. Sentences about the robot come from the server, in the same language. */

import { byId, make, makeButton } from "./dom.js";

const STORED = "chatrobot-language";
/** Each language by its own name, and the tag that a browser knows it by. */
const LANGUAGES = {
  en: ["English", "en"],
  zh: ["中文", "zh-Hans"],
  de: ["Deutsch", "de"],
};

let words = {};
let code = "en";
const listeners = [];

export function language() {
  return code;
}

/** The language to begin with: the one chosen last, else the browser's. */
export function firstLanguage() {
  const chosen = stored();
  return chosen in LANGUAGES ? chosen : browserLanguage();
}

function browserLanguage() {
  return navigator.languages.map((tag) => tag.toLowerCase().split("-")[0]).find((one) => one in LANGUAGES) ?? "en";
}

/** The page's words for `key`, with `{name}` filled in. */
export function t(key, values = {}) {
  const text = words[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? values[name] : whole));
}

/** Write a number with so many decimals, as the page's language does. */
export function decimal(value, digits) {
  const form = { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false };
  return (Number(value.toFixed(digits)) || 0).toLocaleString(LANGUAGES[code][1], form); // no -0
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
  document.documentElement.lang = LANGUAGES[wanted][1];
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

/** Fill the menu in which a person chooses another language. */
export function startLanguageMenu() {
  onLanguage((chosen) => {
    byId("language").textContent = LANGUAGES[chosen][0];
    const others = Object.entries(LANGUAGES).filter(([one]) => one !== chosen);
    byId("languages").replaceChildren(...others.map(([one, [name, tag]]) => {
      const button = makeButton(name, "small quiet", () => {
        byId("language").parentElement.open = false;
        setLanguage(one);
        byId("language").focus();
      });
      button.lang = tag;
      return make("li", "", button);
    }));
  });
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
