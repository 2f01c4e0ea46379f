"use strict";
// Strips of force and residual: drag zooms, a double click shows all, the pointer reads values off, buttons hide lines.
for (const figure of document.querySelectorAll("figure.strip")) {
  const layout = JSON.parse(figure.dataset.layout);
  const svg = figure.querySelector("svg");
  const bytes = Uint8Array.from(atob(figure.querySelector("script").textContent), letter => letter.charCodeAt(0));
  const words = new Uint16Array(bytes.buffer);
  const n = words.length / (1 + layout.lines);
  const column = (index, from, to) =>
    Float64Array.from(words.subarray(index * n, (index + 1) * n), word => from + (to - from) * word / 65535);
  const time = column(0, ...layout.time);
  const names = ["measured", "before", "after"].slice(0, layout.lines);
  const labels = layout.labels;
  const force = names.map((_, index) => column(index + 1, ...layout.force));
  const residual = force.slice(1).map(line => line.map((value, row) => force[0][row] - value));
  const steps = time.slice(1).map((value, row) => value - time[row]).sort();
  const gap = 5 * (steps[steps.length >> 1] || 1);
  const [top, bottom] = layout.frames;
  let [from, to] = layout.time;

  const create = (name, attributes, parent) => {
    const element = document.createElementNS(svg.namespaceURI, name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    if (parent) parent.append(element);
    return element;
  };
  const x = value => top[0] + (value - from) / (to - from) * top[2];
  const y = (value, frame, [low, high]) => frame[1] + (high - value) / (high - low) * frame[3];
  const first = value => {
    let [low, high] = [0, n];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle] < value) low = middle + 1; else high = middle;
    }
    return low;
  };

  // A path through the lowest and the highest sample of each column of pixels.
  const path = (line, frame, ends, rows) => {
    const every = Math.max(1, Math.floor((rows[1] - rows[0]) / 1400));
    let data = "", last = -1;
    for (let start = rows[0]; start < rows[1]; start += every) {
      let [least, most] = [start, start];
      for (let row = start; row < Math.min(start + every, rows[1]); row++) {
        if (line[row] < line[least]) least = row;
        if (line[row] > line[most]) most = row;
      }
      for (const row of least < most ? [least, most] : least > most ? [most, least] : [least]) {
        const jump = last < 0 || time[row] - time[last] > gap * every;
        data += (jump ? "M" : "L") + x(time[row]).toFixed(0) + " " + y(line[row], frame, ends).toFixed(0);
        last = row;
      }
    }
    return data;
  };
  const ticks = (low, high, count) => {
    const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].map(m => m * power).find(step => step >= 0.999 * rough);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (Math.abs(step / power - 2.5) < 1e-9 ? 1 : 0));
    const found = [];
    for (let at = Math.ceil(low / step - 1e-6); at <= high / step + 1e-6; at++)
      found.push([at * step, (at * step).toFixed(Math.min(digits, 9)).replace(/^-0*(\.0*)?$/, "0").replace("-", "−")]);
    return found;
  };
  const letters = (text, attributes, parent) =>
    create("text", { "font-size": 46, fill: "#555555", ...attributes }, parent).textContent = text;
  const axes = forceEnds => {
    const group = svg.querySelector(".axes");
    group.replaceChildren();
    const rule = (data, color) => create("path", { d: data, fill: "none", stroke: color, "stroke-width": 4 }, group);
    for (const [frame, ends, title] of [[top, forceEnds, "force (N)"], [bottom, layout.residual, "residual (N)"]]) {
      const [left, up, width, height] = frame;
      for (const [value, label] of ticks(ends[0], ends[1], frame === top ? 5 : 4)) {
        const at = y(value, frame, ends);
        rule(`M${left} ${at.toFixed(0)}h${width}`, "#E7E7E7");
        letters(label, { x: left - 32, y: at + 16, "text-anchor": "end" }, group);
      }
      for (const [value, label] of ticks(from, to, 12)) {
        rule(`M${x(value).toFixed(0)} ${up}v${height}`, "#E7E7E7");
        if (frame === bottom) letters(label, { x: x(value), y: up + height + 68, "text-anchor": "middle" }, group);
      }
      rule(`M${left} ${up}v${height}h${width}`, "#999999");
      const middle = up + height / 2;
      letters(title, { x: left - 208, y: middle, "text-anchor": "middle", "font-size": 50, fill: "#222222",
        transform: `rotate(270 ${left - 208} ${middle})` }, group);
    }
    letters("time (s)", { x: top[0] + top[2] / 2, y: bottom[1] + bottom[3] + 150, "text-anchor": "middle", "font-size": 50,
      fill: "#222222" }, group);
  };
  const lineOf = (panel, name) => svg.querySelector(`.${panel} .${name} path`);
  const draw = () => {
    const rows = [Math.max(0, first(from) - 1), Math.min(n, first(to) + 1)];
    let [low, high] = [1e300, -1e300];
    for (let row = rows[0]; row < rows[1]; row++) {
      low = Math.min(low, force[0][row]);
      high = Math.max(high, force[0][row]);
    }
    const margin = 0.06 * (high - low) || 1, ends = [low - margin, high + margin];
    names.forEach((name, index) => {
      const line = lineOf("force", name);
      if (line) line.setAttribute("d", path(force[index], top, ends, rows));
      const rest = index > 0 && lineOf("residual", name);
      if (rest) rest.setAttribute("d", path(residual[index - 1], bottom, layout.residual, rows));
    });
    // Shaded stretches were drawn for the whole recording: they only move and widen.
    const scale = (layout.time[1] - layout.time[0]) / (to - from);
    const shift = x(layout.time[0]) - scale * top[0];
    for (const marks of svg.querySelectorAll(".marks")) marks.setAttribute("transform", `matrix(${scale} 0 0 1 ${shift} 0)`);
    axes(ends);
  };
  const zoom = (start, end) => {
    const [low, high] = layout.time;
    const width = Math.min(Math.max(end - start, (high - low) / 2000), high - low);
    from = Math.min(Math.max((start + end - width) / 2, low), high - width);
    to = from + width;
    draw();
  };

  const tools = document.createElement("div");
  tools.className = "tools";
  const button = (text, act) => {
    const element = document.createElement("button");
    element.type = "button";
    element.textContent = text;
    element.addEventListener("click", () => act(element));
    tools.append(element);
    return element;
  };
  for (const [index, name] of names.entries()) {
    button(labels[index], element => {
      const shown = element.getAttribute("aria-pressed") !== "true";
      element.setAttribute("aria-pressed", shown);
      for (const line of svg.querySelectorAll("." + name)) line.style.display = shown ? "" : "none";
    }).setAttribute("aria-pressed", "true");
  }
  const middle = () => (from + to) / 2;
  button("zoom in", () => zoom(middle() - (to - from) / 4, middle() + (to - from) / 4));
  button("zoom out", () => zoom(middle() - (to - from), middle() + (to - from)));
  button("earlier", () => zoom(from - (to - from) / 2, to - (to - from) / 2));
  button("later", () => zoom(from + (to - from) / 2, to + (to - from) / 2));
  button("all", () => zoom(...layout.time));
  const readout = document.createElement("output");
  tools.append(readout);
  figure.prepend(tools);

  const [left, up, width] = top, height = bottom[1] + bottom[3] - up;
  const chosen = create("rect", { y: up, height, width: 0, fill: "#56B4E9", "fill-opacity": 0.25 }, svg);
  const cursor = create("path", { d: "", fill: "none", stroke: "#999999", "stroke-width": 4 }, svg);
  const cover = create("rect", { x: left, y: up, width, height, fill: "#FFFFFF", "fill-opacity": 0, class: "cover" }, svg);
  const at = event => {
    const box = cover.getBoundingClientRect();
    return from + Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1) * (to - from);
  };
  let start = null;
  cover.addEventListener("pointerdown", event => {
    start = at(event);
    cover.setPointerCapture(event.pointerId);
  });
  cover.addEventListener("pointermove", event => {
    const here = at(event);
    if (start !== null) {
      chosen.setAttribute("x", Math.min(x(start), x(here)));
      chosen.setAttribute("width", Math.abs(x(here) - x(start)));
    }
    const row = Math.min(first(here), n - 1);
    const number = value => value.toFixed(2).replace("-", "−");
    cursor.setAttribute("d", `M${x(time[row]).toFixed(0)} ${up}v${height}`);
    readout.textContent = `${number(time[row])} s: ` +
      names.map((_, index) => `${labels[index]} ${number(force[index][row])} N`).join(", ");
  });
  const finish = event => {
    if (start !== null && Math.abs(at(event) - start) > (to - from) / 100) zoom(...[start, at(event)].sort((a, b) => a - b));
    start = null;
    chosen.setAttribute("width", 0);
  };
  cover.addEventListener("pointerup", finish);
  cover.addEventListener("pointercancel", () => { start = null; chosen.setAttribute("width", 0); });
  cover.addEventListener("pointerleave", () => cursor.setAttribute("d", ""));
  cover.addEventListener("dblclick", () => zoom(...layout.time));
}
