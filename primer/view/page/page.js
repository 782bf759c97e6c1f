// Looks up the state that the reader asks for, and puts it on the page. Nothing is computed here.
"use strict";

(async () => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const names = ["a", "n"], at = { a: data.begin[0], n: data.begin[1] };
  const find = (id) => document.getElementById(id);
  const model = (look) => Bokeh.documents.map(look).find((found) => found);

  // ---- the state, put on the page

  function put(element, text) {
    if (element.textContent !== text) element.textContent = text; // what has not changed is not read out again
  }

  function numbers(place) {
    return new Float32Array(Uint8Array.from(atob(data.arrays[place]), (c) => c.charCodeAt(0)).buffer);
  }

  function show() {
    const state = data.states[at.a][at.n];
    for (const name of names) {
      const value = data[name][at[name]];
      find(`${name}-slider`).value = at[name];
      find(`${name}-slider`).setAttribute("aria-valuetext", value);
      find(`${name}-number`).value = value;
    }
    for (const button of document.querySelectorAll(".presets button"))
      button.setAttribute("aria-pressed", names.every((name) => Number(button.dataset[name]) === at[name]));
    find("verdict").dataset.kind = state.kind;
    put(find("verdict"), state.verdict);
    for (const [name, text] of Object.entries(state.numbers)) put(find(`number-${name}`), text);
    for (const [name, text] of Object.entries(state.alts)) find(`${name}-picture`).setAttribute("aria-label", text);
    for (const [name, text] of Object.entries(state.labels)) {
      find(`key-${name}`).hidden = text === "";
      put(find(`key-${name}`).lastElementChild, text);
    }
    for (const [name, curve] of Object.entries(state.curves))
      sources[name].data = Object.fromEntries(Object.entries(curve).map(([axis, place]) => [axis, numbers(place)]));
  }

  function move(places, said = "") {
    Object.assign(at, places);
    put(find("note"), said);
    show();
    clearTimeout(move.waiting); // browsers count how often the address changes
    move.waiting = setTimeout(() => history.replaceState(null, "", `#a=${data.a[at.a]}&n=${data.n[at.n]}`), 150);
  }

  // ---- what the reader asks for

  /** The place of the value nearest to what was typed, and what to say if that is another one. */
  function nearest(name, text) {
    const value = text.trim() === "" ? NaN : Number(text), symbol = name === "n" ? "N" : name;
    if (!Number.isFinite(value))
      return [at[name], `${symbol} must be a number: it stays ${data[name][at[name]]}.`];
    const gaps = data[name].map((each) => Math.abs(each - value));
    const place = gaps.indexOf(Math.min(...gaps)), found = data[name][place];
    return [place, found === value ? "" : `${symbol} = ${text} is not on this page: the nearest is ${found}.`];
  }

  function readAddress() {
    const asked = new URLSearchParams(location.hash.slice(1)), places = {}, said = [];
    for (const name of names) {
      if (!asked.has(name)) continue;
      const [place, note] = nearest(name, asked.get(name));
      places[name] = place;
      if (note) said.push(note);
    }
    move(places, said.join(" "));
  }

  for (const name of names) {
    find(`${name}-slider`).addEventListener("input", (event) => move({ [name]: Number(event.target.value) }));
    const box = find(`${name}-number`);
    box.addEventListener("change", () => {
      const [place, said] = nearest(name, box.value);
      move({ [name]: place }, said);
    });
    box.addEventListener("keydown", (event) => {
      const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (!step) return;
      event.preventDefault(); // to the next state, not to the next whole number
      move({ [name]: Math.min(Math.max(at[name] + step, 0), data[name].length - 1) });
    });
  }
  for (const button of document.querySelectorAll(".presets button"))
    button.addEventListener("click", () => move({ a: Number(button.dataset.a), n: Number(button.dataset.n) }));
  addEventListener("hashchange", readAddress);

  // ---- the plots

  function paint() {
    const style = getComputedStyle(document.documentElement);
    for (const [id, property, variable] of data.paint)
      model((each) => each.get_model_by_id(id))[property] = style.getPropertyValue(variable).trim();
  }

  for (const plot of data.plots) await Bokeh.embed.embed_item(plot);
  const curves = Object.keys(data.states[0][0].curves);
  const sources = Object.fromEntries(curves.map((name) => [name, model((each) => each.get_model_by_name(name))]));
  paint();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
  readAddress();
  document.documentElement.dataset.ready = "yes";
})();
