/** The robot's camera: the newest picture, asked for while the panel is open and the page is seen; kept nowhere. */

import { on, send, state } from "./connection.js";
import { byId, setText } from "./dom.js";
import { onLanguage, t } from "./words.js";

const NEXT_MS = 50;
const AGAIN_MS = 1000;

const panel = byId("camera");
const image = byId("camera-picture");
let timer = 0;

function look() {
  clearTimeout(timer);
  if (panel.open && !document.hidden) send({ do: "look" });
  else if (!panel.open) show(null);
}

function show(data) {
  image.hidden = !data;
  if (data) image.src = data;
  else image.removeAttribute("src");
}

/** Every picture asks for the next: a network that is slow gets fewer. */
function hear({ data }) {
  if (!panel.open) return;
  show(data);
  setText(byId("camera-said"), data ? "" : t("camera_none"));
  clearTimeout(timer);
  timer = setTimeout(look, data ? NEXT_MS : AGAIN_MS);
}

export function startCamera() {
  on("open", () => {
    panel.hidden = !state.hello.robot.has_camera;
    look();
  });
  on("closed", () => show(null)); // what was seen last is not what it sees now
  on("picture", hear);
  panel.addEventListener("toggle", look);
  document.addEventListener("visibilitychange", look);
  onLanguage(() => {
    image.alt = t("camera_alt");
    setText(byId("camera-said"), "");
  });
}
