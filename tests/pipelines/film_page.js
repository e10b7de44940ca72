// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Runs the scripts of a page that spidartrack export has made on what a browser would give them:
// node film_page.js PAGE TIME... . Prints as JSON what is shown and felt at each time, in seconds,
// of a film that is 800 x 480 pixels large, and after a pause. PAGE_BROWSER names another browser than one with a gamepad.
"use strict";
const fs = require("fs");
const vm = require("vm");

const [data, script] = [...fs.readFileSync(process.argv[2], "utf8")
  .matchAll(/<script[^>]*>([^]*?)<\/script>/g)].map((found) => found[1]);

let places = [], tip = null, origin = null, box = null, ring = null, comes = null, dash = [], pulses = [], vibrated_ms = [], every = null, next = null;
let scale = null;  // pixels of the canvas in one of the page
const pen = {
  setTransform(across, _0, _1, down) { scale = [across, down]; },
  beginPath() { places = []; },
  moveTo(x, y) { places.push([x, y]); },
  lineTo(x, y) { places.push([x, y]); },
  arc(_x, _y, radius) { [ring, comes] = [radius, dash.length === 0]; },
  setLineDash(lengths) { dash = lengths; },
  clearRect() { tip = origin = box = ring = comes = null; },
  // The second corner of the head.
  fillRect() {},
  fillText() {},
  fill() { if (pen.fillStyle === "white") tip = [places[1][0] - origin[0], origin[1] - places[1][1]]; },
  closePath() {},
  stroke() { if (places.length === 2) [origin] = places; },  // the shaft
  strokeRect(...args) { box = args; },
};
const part = (more) => ({ addEventListener() {}, ...more });
const on = {};
const film = part({ addEventListener(name, call) { on[name] = call; }, clientWidth: 800, clientHeight: 480, videoWidth: 400, videoHeight: 240, currentTime: 0, readyState: 4 });
const parts = {
  track: { textContent: data }, film, said: part(), how: part(), begin: part(), wide: part(), stage: part({ requestFullscreen() {} }), pad: part(), rumble: part({ checked: true }),
  arrow: { getContext: () => pen },
};
const actuator = { playEffect(kind, effect) { pulses.push(effect.strongMagnitude); return Promise.resolve(); } };
const page = {
  document: { getElementById: (id) => parts[id] },
  navigator: { getGamepads: () => [null, { vibrationActuator: actuator }], vibrate(ms) { vibrated_ms.push(ms); } },
  atob, Uint8Array, Math, Array, JSON,
  requestAnimationFrame(call) { next = call; },
  ResizeObserver: class { observe() {} },
  addEventListener() {},
  setInterval(call) { every = call; },
};
const others = {
  firefox: { getGamepads: () => [{ id: "A Pad", vibrationActuator: null, hapticActuators: [] }] },
  policy: { getGamepads() { throw new Error("disallowed by permissions policy"); }, vibrate: page.navigator.vibrate },
  insecure: { vibrate: page.navigator.vibrate },
  iphone: { getGamepads: () => [] },
};
const other = process.env.PAGE_BROWSER;
if (other) page.navigator = others[other];
page.isSecureContext = other !== "insecure";
if (other === "iphone") delete parts.stage.requestFullscreen;
vm.runInNewContext(script, page);

const moments = process.argv.slice(3).map((time) => {
  film.currentTime = Number(time);
  pulses = [];
  vibrated_ms = [];
  next();
  every();
  return { tip, origin, box, ring, comes, said: parts.said.textContent, pulses, vibrated_ms };
});
/** The strongest of ten pulses, after the first three, while the film is so and its time runs or stands. */
const strongest = (state, step_s) => {
  Object.assign(film, state);
  pulses = [];
  vibrated_ms = [];
  for (let i = 0; i < 13; ++i) {
    if (i === 3) pulses = [];
    film.currentTime += step_s;
    every();
  }
  return Math.max(0, ...pulses);
};
const waiting = [{ readyState: 2 }, { seeking: true }, {}].map((state) => {
  const rests = strongest(state, 0);
  return [rests, strongest({ readyState: 4, seeking: false }, .001)];
});
const canvases = [1, 2, 1.25].map((fineness) => {
  page.devicePixelRatio = fineness;
  next();
  return [parts.arrow.width, parts.arrow.height, ...scale];
});
film.paused = true;
next();
next = null;
const drawsPaused = next !== null;
pulses = [];
vibrated_ms = [];
for (let i = 0; i < 3; ++i) every();
/** Where it stands when it was opened, and whether with controls; and when it plays. */
const poster = () => {
  film.currentTime = 0;
  on.loadedmetadata();
  const poster = [film.currentTime, !!film.controls];
  on.play();
  return [...poster, film.currentTime, film.controls];
};
console.log(JSON.stringify({
  poster: poster(), drawsPaused, how: parts.how.textContent, moments, waiting, canvases, paused: { pulses, vibrated_ms }, url: film.src, title: page.document.title,
  about: parts.pad.textContent, wide: !parts.wide.hidden, most_N: JSON.parse(data).most_N, later_s: JSON.parse(data).later_s }));
