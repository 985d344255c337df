/** The document: find an element, make one. What comes from elsewhere goes in as text alone, never as markup. */

const REST_MS = 1000;

export function byId(id) {
  return document.getElementById(id);
}

/** Make an element; `children` that are no elements become its text. */
export function make(tag, className = "", ...children) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  element.append(...children.map((child) => (child instanceof Node ? child : String(child))));
  return element;
}

/** Make a button that does `act` when it is pressed. */
export function makeButton(text, className, act) {
  const button = make("button", className, text);
  button.type = "button";
  button.addEventListener("click", act);
  return button;
}

const resting = new WeakMap();

/** Have a button do nothing for a second: a finger that hammers, on it or near by, means no second press. */
export function restButton(button) {
  clearTimeout(resting.get(button));
  button.disabled = true;
  resting.set(button, setTimeout(() => (button.disabled = false), REST_MS));
}

/** Set a text only where it changed: a live region would read it out again. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Set the text of a button that has another one at times: it is as wide as the wider of both, and moves nothing. */
export function setChanging(button, text, other) {
  setText(button, text);
  button.dataset.other = other;
}

export function setPressed(button, isPressed) {
  button.setAttribute("aria-pressed", String(isPressed));
}

export function isPressed(button) {
  return button.getAttribute("aria-pressed") === "true";
}

/** Keys belong to an element in which a person writes or chooses. */
export function isField(element) {
  return element instanceof HTMLElement && (element.matches("input, textarea, select") || element.isContentEditable);
}

/** Of the fields, those in which the space bar writes a space. */
export function isTextField(element) {
  return isField(element) && !element.matches("input[type=range], select");
}

/** Have this tab keep a text over a reload; a browser that keeps nothing forgets it. */
export function keepInTab(key, text) {
  try {
    sessionStorage.setItem(key, text);
  } catch {
    // it is typed again
  }
}

/** Return, once, what this tab has kept; "" for nothing. */
export function takeFromTab(key) {
  try {
    const text = sessionStorage.getItem(key) ?? "";
    sessionStorage.removeItem(key);
    return text;
  } catch {
    return "";
  }
}

/** Show `text` in a banner; an empty one hides it. */
export function setBanner(element, text) {
  setText(element, text);
  element.hidden = !text;
}

/** Menus are walked with the arrows, and close with Esc, which stops the robot all the same. */
export function startMenus() {
  addEventListener("keydown", (event) => {
    const menu = event.target.closest(".menu[open]");
    if (event.key === "Escape") {
      if (menu) menu.querySelector("summary").focus();
      for (const one of document.querySelectorAll(".menu[open]")) one.open = false;
    }
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!menu || !by) return;
    event.preventDefault();
    const stops = [...menu.querySelectorAll("summary, button:enabled")];
    const at = stops.indexOf(document.activeElement) + by;
    stops[(at + stops.length) % stops.length].focus();
  });
}
