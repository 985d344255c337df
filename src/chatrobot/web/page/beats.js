/** A worker that ticks: timers of a page are held back in a tab that is not looked at, those of a worker are not. */

const PERIOD_MS = 50;

setInterval(() => postMessage(null), PERIOD_MS);
