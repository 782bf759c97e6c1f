// Looks up the state that the reader asks for, and draws what was recorded of it. No equation stands here:
// growth in closed form is that of the polynomial whose coefficients came with the page.
"use strict";

(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const shelves = data.shelves, at = data.begin.slice();
  const find = (id) => document.getElementById(id);
  const NS = "http://www.w3.org/2000/svg", W = 400, H = 300, LEFT = 56, RIGHT = 12, TOP = 10, BOTTOM = 42;
  if (window.parent !== window) document.documentElement.classList.add("inside");

  // ---- what was recorded

  const opened = new Map();
  function numbers(place) {
    if (!opened.has(place))
      opened.set(place, new Float32Array(Uint8Array.from(atob(data.arrays[place]), (c) => c.charCodeAt(0)).buffer));
    return opened.get(place);
  }

  function state() {
    let place = 0;
    shelves.forEach((shelf, k) => { place = place * shelf.places.length + at[k]; });
    return data.states[place];
  }

  // ---- drawing

  function node(name, attributes, parent, text) {
    const made = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  }

  const SCALES = { linear: (x) => x, log: (x) => (x > 0 || Number.isNaN(x) ? Math.log10(x) : -400), asinh: (x, width) => Math.asinh(x / width) };

  /** The place of a number on an axis, from 0 to 1. */
  function along(axis) {
    const scale = (x) => SCALES[axis.scale](x, axis.width), [low, high] = axis.limits.map(scale);
    return (x) => (scale(x) - low) / (high - low);
  }

  const inside = (x) => Math.min(Math.max(x, -4), 5); // what is far outside of the frame stays drawable

  function places(frame) {
    if (frame.kind === "disc") {
      const r = H / 2 - 24;
      return { x: (x) => W / 2 + r * x, y: (y) => H / 2 - r * y, fx: (x) => x * W, fy: (y) => H - y * H };
    }
    const [x, y] = [along(frame.x), along(frame.y)];
    const fx = (f) => LEFT + f * (W - LEFT - RIGHT), fy = (f) => H - BOTTOM - f * (H - TOP - BOTTOM);
    return { x: (value) => fx(inside(x(value))), y: (value) => fy(inside(y(value))), fx, fy };
  }

  function axes(frame, put, svg) {
    const ink = { "font-size": 12, fill: "#1a1a1a" };
    if (frame.kind === "disc") {
      for (const [r, label] of frame.rings) {
        node("circle", { cx: W / 2, cy: H / 2, r: r * (H / 2 - 24), fill: "none", stroke: r === 1 ? "#333" : "#ddd" }, svg);
        node("text", { ...ink, x: put.x(r * 0.93) + 2, y: put.y(r * 0.37), "font-size": 10 }, svg, label);
      }
      node("text", { ...ink, x: put.x(1) + 6, y: H / 2 + 4 }, svg, frame.names[0]);
      node("text", { ...ink, x: W / 2, y: 15, "text-anchor": "middle" }, svg, frame.names[1]);
      return;
    }
    for (const [value, label] of frame.x.ticks) {
      node("path", { d: `M${put.x(value)} ${TOP}V${H - BOTTOM}`, stroke: "#e2e2e2" }, svg);
      node("text", { ...ink, x: put.x(value), y: H - BOTTOM + 16, "text-anchor": "middle" }, svg, label);
    }
    for (const [value, label] of frame.y.ticks) {
      node("path", { d: `M${LEFT} ${put.y(value)}H${W - RIGHT}`, stroke: "#e2e2e2" }, svg);
      node("text", { ...ink, x: LEFT - 6, y: put.y(value) + 4, "text-anchor": "end" }, svg, label);
    }
    node("text", { ...ink, x: (LEFT + W - RIGHT) / 2, y: H - 6, "text-anchor": "middle" }, svg, frame.x.label);
    const middle = (TOP + H - BOTTOM) / 2;
    node("text", { ...ink, x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` }, svg, frame.y.label);
    node("path", { d: `M${LEFT} ${TOP}V${H - BOTTOM}H${W - RIGHT}`, stroke: "#333", fill: "none" }, svg);
  }

  const DRAW = {
    line(part, put, layer) {
      const [x, y] = coordinates(part, put);
      if (part.dash !== null)
        node("path", { d: path(x, y), fill: "none", stroke: part.colour, "stroke-width": part.width * 1.2, "stroke-dasharray": part.dash || "none", "stroke-linejoin": "round" }, layer);
      if (part.marker)
        for (let k = 0; k < x.length; k++) if (Number.isFinite(y[k])) marker(part, x[k], y[k], layer);
    },
    area(part, put, layer) {
      const [x, y] = coordinates(part, put);
      node("path", { d: path(x, y), fill: part.fill }, layer);
    },
    cells(part, put, layer) {
      const x = Array.from(numbers(part.x), put.x), y = Array.from(numbers(part.y), put.y), n = x.length - 1;
      part.colours.forEach((colour, k) => {
        const i = k % n, j = Math.floor(k / n);
        if (colour) node("rect", { x: x[i], y: y[j + 1], width: x[i + 1] - x[i] + 0.5, height: y[j] - y[j + 1] + 0.5, fill: colour }, layer);
      });
    },
    text(part, put, layer) {
      const [x, y, dx, dy] = part.at;
      const left = (part.in[0] === "d" ? put.x : put.fx)(x) + dx, top = (part.in[1] === "d" ? put.y : put.fy)(y) - dy;
      part.text.split("\n").forEach((row, k) => node("text", { x: left, y: top + 12 * k, "font-size": 11, fill: part.colour, "text-anchor": part.anchor, "paint-order": "stroke", stroke: "#fff", "stroke-width": 3, "stroke-opacity": 0.7 }, layer, row));
    },
  };

  function marker(look, x, y, layer) {
    const r = look.size * 0.65, fill = look.face || "none";
    if (look.marker === "s") node("rect", { x: x - r, y: y - r, width: 2 * r, height: 2 * r, fill, stroke: look.edge }, layer);
    else if (look.marker === "X") node("path", { d: `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`, stroke: look.face, "stroke-width": r * 0.7 }, layer);
    else node("circle", { cx: x, cy: y, r, fill, stroke: look.edge }, layer);
  }

  function coordinates(part, put) {
    const x = part.in[0] === "d" ? put.x : put.fx, y = part.in[1] === "d" ? put.y : put.fy;
    return [Array.from(numbers(part.x), x), Array.from(numbers(part.y), y)];
  }

  function path(x, y) {
    let text = "", pen = "M";
    for (let k = 0; k < x.length; k++) {
      if (Number.isNaN(x[k]) || Number.isNaN(y[k])) pen = "M";
      else { text += `${pen}${x[k].toFixed(1)} ${y[k].toFixed(1)}`; pen = "L"; }
    }
    return text;
  }

  const drawn = [];
  function panel(k, place) {
    if (drawn[k] === place) return; // what has not changed is not drawn again
    drawn[k] = place;
    const [frameAt, parts, keyAt] = data.panels[place], frame = data.parts[frameAt], key = data.parts[keyAt];
    put(find(`title-${k}`), frame.title);
    const box = find(`plot-${k}`);
    if (frame.kind === "text") {
      const pre = document.createElement("pre");
      pre.textContent = parts.map((each) => data.parts[each].text).join("\n");
      box.replaceChildren(pre);
      find(`key-${k}`).replaceChildren();
      return;
    }
    const svg = node("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": words(frame, key) });
    const put_ = places(frame), clip = `clip-${k}`;
    node("rect", frame.kind === "disc" ? { width: W, height: H } : { x: LEFT, y: TOP - 4, width: W - LEFT - RIGHT + 5, height: H - TOP - BOTTOM + 8 }, node("clipPath", { id: clip }, svg));
    const under = node("g", { "clip-path": `url(#${clip})` }, svg);
    axes(frame, put_, svg);
    const layer = node("g", { "clip-path": `url(#${clip})` }, svg);
    for (const each of parts.map((one) => data.parts[one])) DRAW[each.kind](each, put_, each.kind === "area" && frame.kind !== "disc" || each.kind === "cells" ? under : layer);
    box.replaceChildren(svg);
    find(`key-${k}`).replaceChildren(...key.map(row));
  }

  function row(look) {
    const item = document.createElement("li"), sample = node("svg", { width: 30, height: 14, "aria-hidden": "true" });
    if (look.fill) node("rect", { width: 30, height: 14, fill: look.fill, stroke: "#999" }, sample);
    else if (look.dash !== null) node("path", { d: "M0 7H30", stroke: look.colour, "stroke-width": Math.min(look.width * 1.2, 4), "stroke-dasharray": look.dash || "none" }, sample);
    if (look.marker) marker(look, 15, 7, sample);
    item.append(sample, look.text);
    return item;
  }

  function words(frame, key) {
    const what = frame.kind === "disc" ? "over direction" : `${frame.y.label} against ${frame.x.label}`;
    return `${frame.title}: ${what}. ${key.map((each) => each.text).join("; ")}`;
  }

  /** What is drawn of each picture, for those who check: lines as lists of numbers. */
  window.primerShown = () => state()[1].map((place) => data.panels[place][1].map((one) => data.parts[one])
    .filter((part) => part.kind === "line").map((part) => [Array.from(numbers(part.x)), Array.from(numbers(part.y))]));

  // ---- growth in closed form, where the page has the coefficients of a polynomial

  const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
  const over = (a, b) => { const s = b[0] * b[0] + b[1] * b[1]; return [(a[0] * b[0] + a[1] * b[1]) / s, (a[1] * b[0] - a[0] * b[1]) / s]; };

  /** Coefficients of the powers of lambda, the constant one first. */
  function coefficients(form, wave, values) {
    const found = [], numbers = [...wave, ...values];
    for (const [re, im, power, ...powers] of form.terms) {
      const size = powers.reduce((product, p, k) => product * numbers[k] ** p, 1);
      while (found.length <= power) found.push([0, 0]);
      found[power] = [found[power][0] + re * size, found[power][1] + im * size];
    }
    while (found.length > 1 && found.at(-1)[0] === 0 && found.at(-1)[1] === 0) found.pop();
    return found;
  }

  /** All roots, by Ehrlich and Aberth's iteration. */
  function roots(c) {
    const n = c.length - 1;
    if (n < 1) return [];
    const size = (z) => Math.hypot(z[0], z[1]), lead = size(c[n]);
    const r = Math.max(...c.slice(0, n).map((each, k) => (size(each) / lead) ** (1 / (n - k)))) || 1;
    const z = Array.from({ length: n }, (_, k) => [r * Math.cos((2 * Math.PI * k) / n + 0.4), r * Math.sin((2 * Math.PI * k) / n + 0.4)]);
    for (let step = 0; step < 200; step++) {
      let moved = 0;
      for (let k = 0; k < n; k++) {
        let p = c[n], slope = [0, 0];
        for (let j = n - 1; j >= 0; j--) {
          slope = times(slope, z[k]); slope = [slope[0] + p[0], slope[1] + p[1]];
          p = times(p, z[k]); p = [p[0] + c[j][0], p[1] + c[j][1]];
        }
        if (size(p) === 0) continue;
        let pull = [0, 0];
        for (let j = 0; j < n; j++) if (j !== k) {
          const gap = [z[k][0] - z[j][0], z[k][1] - z[j][1]];
          if (size(gap) > 0) { const one = over([1, 0], gap); pull = [pull[0] + one[0], pull[1] + one[1]]; }
        }
        const ratio = over(slope, p), change = over([1, 0], [ratio[0] - pull[0], ratio[1] - pull[1]]);
        if (!Number.isFinite(change[0] + change[1])) continue;
        z[k] = [z[k][0] - change[0], z[k][1] - change[1]];
        moved = Math.max(moved, size(change) / (size(z[k]) || 1));
      }
      if (moved < 1e-15) break;
    }
    return z;
  }

  /** The largest real part of lambda at each |xi|, over the ways that waves may go; null where there is no root. */
  function growth(form, values) {
    return form.xi.map((k) => {
      const real = form.ways.flatMap((way) => roots(coefficients(form, way.map((w) => w * k), values)))
        .map(([re, im]) => (Math.abs(re) <= 1e-11 * Math.hypot(re, im) ? 0 : re));
      return real.length ? Math.max(...real) : null;
    });
  }
  window.primerGrowth = (k, values) => growth(data.closed[k], values); // for those who check

  let own = -1;
  function showOwn() {
    if (!data.closed.length || own === at[0]) return;
    own = at[0];
    const form = data.closed[own];
    find("own").hidden = !form;
    if (!form) return;
    const boxes = form.names.map((name, k) => {
      const control = document.createElement("div"), label = document.createElement("label"), box = document.createElement("input");
      control.className = "control";
      Object.assign(box, { type: "text", inputMode: "decimal", id: `own-${name}`, value: form.values[k] });
      label.htmlFor = box.id;
      label.textContent = name;
      box.addEventListener("change", draw);
      control.append(label, box);
      return control;
    });
    find("own-numbers").replaceChildren(...boxes);
    function draw() {
      const values = form.names.map((name) => (find(`own-${name}`).value.trim() === "" ? NaN : Number(find(`own-${name}`).value)));
      if (!values.every(Number.isFinite)) return put(find("own-said"), "Each of these must be a number: the picture is of the numbers before.");
      const rate = growth(form, values), frame = structuredClone(data.parts[data.panels[state()[1][0]][0]]), most = Math.max(...rate);
      frame.y.limits = [Math.min(-2, Math.min(...rate) * 1.2), Math.max(2, most * 1.5)];
      frame.y.ticks = [-1e12, -1e9, -1e6, -1e3, -1, 0, 1, 1e3, 1e6, 1e9, 1e12].filter((v) => v >= frame.y.limits[0] && v <= frame.y.limits[1]).map((v) => [v, v.toExponential(0).replace("e+0", v ? "" : "").replace("e+", "e")]);
      const base = form.names.map((name, k) => `${name} = ${values[k]}`).join(", ");
      const svg = node("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `Growth rate against wavenumber${base ? ` at ${base}` : ""}` }), put_ = places(frame);
      axes(frame, put_, svg);
      node("path", { d: path(form.xi.map(put_.x), rate.map(put_.y)), fill: "none", stroke: "#000", "stroke-width": 2 }, svg);
      node("path", { d: `M${LEFT} ${put_.y(0)}H${W - RIGHT}`, stroke: "#666" }, svg);
      find("own-plot").replaceChildren(svg);
      put(find("own-said"), `${base ? `At ${base}: of` : "Of"} waves with |ξ| from ${form.xi[0]} to ${form.xi.at(-1).toFixed(0)}, the fastest ${most > 0 ? `grows like e^(${most.toPrecision(6)} t)` : "does not grow"}. What still shorter waves do is for primer verdict.`);
    }
    draw();
  }

  // ---- the state, put on the page

  function put(element, text) {
    if (element.textContent !== text) element.textContent = text; // what has not changed is not read out again
  }

  function show() {
    shelves.forEach((shelf, k) => {
      const text = shelf.places[at[k]], slider = find(`slider-${shelf.name}`);
      if (!slider) { find(`select-${shelf.name}`).value = at[k]; return; }
      slider.value = at[k];
      slider.setAttribute("aria-valuetext", text);
      find(`number-${shelf.name}`).value = text;
    });
    for (const button of document.querySelectorAll("button[data-at]"))
      button.setAttribute("aria-pressed", JSON.parse(button.dataset.at).every((place, k) => place === null || place === at[k]));
    const [verdict, panels] = state();
    put(find("verdict"), data.verdicts[verdict]);
    panels.forEach((place, k) => panel(k, place));
    showOwn();
    document.documentElement.dataset.state = at.join(" ");
  }

  function move(changes, said = "") {
    for (const [k, place] of changes) at[k] = Math.min(Math.max(place, 0), shelves[k].places.length - 1);
    put(find("note"), said);
    show();
    clearTimeout(move.waiting); // browsers count how often the address changes
    move.waiting = setTimeout(() => {
      const asked = shelves.map((shelf, k) => `${shelf.name}=${encodeURIComponent(shelf.places[at[k]])}`);
      history.replaceState(null, "", `#${asked.join("&")}`);
    }, 150);
  }

  /** The place nearest to what was typed, and what to say if that is another one. */
  function nearest(k, text) {
    const { label, places } = shelves[k], exact = places.indexOf(text.trim());
    if (exact >= 0) return [exact, ""];
    const value = text.trim() === "" ? NaN : Number(text);
    if (!Number.isFinite(value) || !Number.isFinite(Number(places[0])))
      return [at[k], `${label} must be ${Number.isFinite(Number(places[0])) ? "a number" : `one of ${places.join(", ")}`}: it stays ${places[at[k]]}.`];
    const gaps = places.map((each) => Math.abs(Number(each) - value)), place = gaps.indexOf(Math.min(...gaps));
    return [place, Number(places[place]) === value ? "" : `${label} = ${text} is not on this page: the nearest is ${places[place]}.`];
  }

  function readAddress() {
    const asked = new URLSearchParams(location.hash.slice(1)), changes = [], said = [];
    shelves.forEach((shelf, k) => {
      if (!asked.has(shelf.name)) return;
      const [place, note] = nearest(k, asked.get(shelf.name));
      changes.push([k, place]);
      if (note) said.push(note);
    });
    move(changes, said.join(" "));
  }

  shelves.forEach((shelf, k) => {
    const slider = find(`slider-${shelf.name}`);
    if (!slider) {
      find(`select-${shelf.name}`).addEventListener("change", (event) => move([[k, Number(event.target.value)]]));
      return;
    }
    slider.addEventListener("input", (event) => move([[k, Number(event.target.value)]]));
    const box = find(`number-${shelf.name}`), play = find(`play-${shelf.name}`);
    box.addEventListener("change", () => {
      const [place, said] = nearest(k, box.value);
      move([[k, place]], said);
    });
    box.addEventListener("keydown", (event) => {
      const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (!step) return;
      event.preventDefault(); // to the next state, not to the next whole number
      move([[k, at[k] + step]]);
    });
    if (!play) return;
    let ticking = 0;
    const stop = () => { clearInterval(ticking); ticking = 0; play.textContent = "play"; };
    play.addEventListener("click", () => {
      if (ticking) return stop();
      play.textContent = "stop";
      if (at[k] === shelf.places.length - 1) move([[k, 0]]);
      ticking = setInterval(() => {
        const before = state()[1].join();
        move([[k, at[k] + 1]]);
        if (at[k] === shelf.places.length - 1 || state()[1].join() === before) stop(); // or the run has ended
      }, 300);
    });
  });
  for (const button of document.querySelectorAll("button[data-at]"))
    button.addEventListener("click", () => move(JSON.parse(button.dataset.at).flatMap((place, k) => (place === null ? [] : [[k, place]]))));
  addEventListener("hashchange", readAddress);
  const tell = () => window.parent !== window && window.parent.postMessage({ height: document.documentElement.offsetHeight, name: window.name }, "*");
  new ResizeObserver(tell).observe(document.body);

  readAddress();
  document.documentElement.dataset.ready = "yes";
})();
