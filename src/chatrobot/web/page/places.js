/** Places: what they are called in the page's language, and the menu that goes to them without a pointer. */

import { on, send, state, tell } from "./connection.js";
import { byId, make, makeButton } from "./dom.js";
import { language, onLanguage, t } from "./words.js";

/** Return what a place is called in the page's language. */
export function placeName(place) {
  return place.called?.[language()] ?? place.name;
}

/** Return what an obstacle is called: by its own names, else as the place of that name is. */
export function obstacleName(obstacle, places) {
  if (obstacle.names?.length > 1 || placeName(obstacle) !== obstacle.name) return placeName(obstacle);
  const name = obstacle.name.toLowerCase();
  const place = places.find((one) => (one.names || [one.name]).includes(name));
  return place ? placeName(place) : obstacle.name;
}

/** Begin. `asks` says whether a way that was pointed at is asked about before it is driven. */
export function startPlaces(asks) {
  const draw = () => {
    const places = state.hello ? state.hello.world.places : [];
    byId("places-menu").hidden = !places.length;
    byId("places").replaceChildren(...places.map((place) => {
      const button = makeButton(placeName(place), "small quiet", () => {
        byId("places-menu").open = false;
        const text = t("example_place", { place: button.textContent });
        const point = { x_m: place.x_m, y_m: place.y_m, yaw_rad: null, place: button.textContent, text };
        if (send({ do: "go", ...point, ask: asks() }) && asks()) tell({ is: "asking" });
      });
      button.disabled = !state.steers;
      return make("li", "", button);
    }));
  };
  for (const kind of ["open", "steering", "closed"]) on(kind, draw);
  on("places", (message) => {
    state.hello.world.places = message.places;
    draw();
  });
  onLanguage(draw);
}
