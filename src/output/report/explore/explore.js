// Charts that the reader chooses, over the columns of all jobs. Rows are numbers from 0; a column has a value for each row.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const rows = [...Array(data.count).keys()];
  for (const column of data.columns) {
    const [names, places] = column.names || [];
    column.values = column.numbers || (names ? places.map((place) => place === null ? null : names[place]) : Array(data.count).fill(column.all));
  }
  const columns = new Map(data.columns.map((column) => [column.name, column]));
  const isNumber = (column) => column.values.every((value) => value === null || typeof value === "number");
  const varies = (column) => new Set(column.values.filter((value) => value !== null)).size > 1;
  const numbers = data.columns.filter(isNumber);
  const parameters = data.columns.filter((column) => column.kind === "parameter" && varies(column));
  const results = numbers.filter((column) => column.kind !== "parameter" && varies(column));
  const title = (column) => column.unit ? `${column.name} [${column.unit}]` : column.name;
  const short = (value) => {
    if (value === null || typeof value !== "number") return value === null ? "–" : String(value);
    const near = Number(value.toPrecision(5));
    const size = Math.abs(near);
    return near !== 0 && (size >= 1e6 || size < 1e-3) ? near.toExponential().replace("e+", "e") : String(near);
  };
  const MOST_SERIES = 24;
  const MOST_JOINED = 200;
  const MOST_TICKS = 12;
  const GREY = "#999999";
  const CROSS = "path://M0,2L2,0L5,3L8,0L10,2L7,5L10,8L8,10L5,7L2,10L0,8L3,5Z";

  const root = document.getElementById("explore");
  const make = (name, attributes = {}, ...children) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };
  const select = (label, options, chosen) => {
    const box = make("select", { "aria-label": label });
    for (const column of options) {
      const option = make("option", { value: column.name, title: column.meaning || "" }, column.name ? title(column) : column.label);
      option.selected = column.name === chosen;
      box.append(option);
    }
    return [make("label", {}, label, box), box];
  };
  const flag = (label, checked) => {
    const box = make("input", { type: "checkbox", "aria-label": label });
    box.checked = checked;
    return [make("label", { class: "flag" }, box, label), box];
  };

  const status = columns.get("status");
  const study = columns.get("study");
  const isMeasured = (row) => status !== undefined && status.values[row] === "measured";
  // The mean rate of a run that is not periodic is no frequency of a limit cycle.
  const isSettled = (column, row) => column.name !== "frequency_hz" || status === undefined || status.values[row] !== "not_periodic";
  const known = (name, list) => list.some((column) => column.name === name) ? name : (list[0] || { name: "" }).name;
  const none = { name: "", label: "–" };
  const startY = known(data.start.y, numbers);
  // The axis of the report, if there is something along it.
  const startX = parameters.some((column) => column.name === data.start.x) || !parameters.length ? data.start.x
    : (parameters.find(isNumber) || parameters[0]).name;
  const [xLabel, x] = select("x", numbers, known(startX, numbers));
  const [yLabel, y] = select("y", numbers, startY);
  const [byLabel, by] = select("colour", [none, ...data.columns.filter(varies)],
    known(data.start.by, [none, ...parameters]) || known("regime", [none, ...data.columns]));
  const second = select("second panel", [none, ...numbers], "");
  const third = select("third panel", [none, ...numbers], "");
  const [xLogLabel, xLog] = flag("log x", isLog(columns.get(x.value)));
  const [yLogLabel, yLog] = flag("log y", false);
  const [joinLabel, join] = flag("lines", parameters.length <= 2);

  // As the report does: as the study's author gave the values, and otherwise logarithmic if they are positive and span a factor of 20.
  function isLog(column) {
    if (!column || column.kind !== "parameter") return false;
    if (data.log[column.name] !== undefined) return data.log[column.name];
    const [least, most] = extent(column);
    return least > 0 && most >= 20 * least;
  }
  // Math.min(...values) cannot take 10⁵ values.
  function extent(column, counts = () => true) {
    let [least, most] = [Infinity, -Infinity];
    for (const [row, value] of column.values.entries()) {
      if (value === null || !counts(row)) continue;
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
    return [least, most];
  }
  // The values that people chose, if they are few.
  const chosen = (column) => {
    const values = [...new Set(column.values.filter((value) => value !== null))].sort((a, b) => a - b);
    return column.kind === "parameter" && values.length <= MOST_TICKS ? values : undefined;
  };
  // On a logarithmic axis 1, 2 and 5 times powers of ten, because the library has only these powers.
  const decades = (column) => {
    const [least, most] = extent(column);
    const ticks = [];
    for (let power = Math.floor(Math.log10(least)); 10 ** power <= most; power += 1) {
      ticks.push(...[1, 2, 5].map((digit) => Number((digit * 10 ** power).toPrecision(1))).filter((tick) => tick >= least && tick <= most));
    }
    return ticks.length > 1 && ticks.length <= 2 * MOST_TICKS ? ticks : undefined;
  };

  const tabs = make("div", { class: "tabs", role: "tablist" });
  const views = ["plot", "parallel coordinates", "importance", "table"].filter((name) =>
    (name !== "parallel coordinates" || parameters.length > 1) && (name !== "importance" || data.importance.length));
  // Without a result there is nothing to draw.
  let view = results.length || data.count === 1 ? views[0] : "table";
  for (const name of views) {
    const tab = make("button", { type: "button", role: "tab" }, name);
    tab.addEventListener("click", () => { view = name; draw(); });
    tabs.append(tab);
  }
  const controls = make("div", { class: "controls" }, xLabel, yLabel, byLabel, second[0], third[0], xLogLabel, yLogLabel, joinLabel);
  const box = make("div", { class: "chart", role: "img", "aria-label": "chart of the chosen quantities; the table has the same values" });
  const table = make("div", { class: "table", tabindex: "0" });
  const job = make("div", { id: "job" });
  job.hidden = true;
  const left = make("p", { class: "left" });
  root.append(tabs, controls, box, left, table, job);

  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  let chart = null;
  const renew = () => {
    if (chart) chart.dispose();
    chart = echarts.init(box, dark.matches ? "dark" : null);
    chart.on("click", (event) => { if (event.data && event.data.row !== undefined) showJob(event.data.row); });
  };

  // A click leads to the job: all its values, its page if it was inspected, and the command that shows it.
  const showJob = (row) => {
    const key = columns.get("job") ? columns.get("job").values[row] : String(row);
    const measured = isMeasured(row);
    job.replaceChildren(make("h3", {}, measured ? `measured point ${key}` : `job ${String(key).slice(0, 12)}`));
    const page = data.pages[row];
    const line = make("p");
    if (!measured) line.append(make("code", {}, `tribosweep show ${String(key).slice(0, 12)}`));
    if (page) line.append(" · ", make("a", { href: page }, "what happens in this job"));
    job.append(line);
    const list = make("dl");
    for (const column of data.columns) {
      const value = column.values[row];
      if (value !== null) list.append(make("div", {}, make("dt", { title: column.meaning }, title(column)), make("dd", {}, short(value))));
    }
    for (const line of measured ? [] : data.setup) list.append(make("div", {}, make("dt", {}, line.name), make("dd", {}, line.value)));
    job.append(list);
    job.hidden = false;
    job.dataset.key = key;
    job.scrollIntoView({ block: "nearest" });
  };

  const axisOf = (column, log, extra) => {
    const ticks = chosen(column);
    const customValues = (log && ticks ? ticks.filter((tick) => tick > 0) : ticks) || (log && extent(column)[0] > 0 ? decades(column) : undefined);
    return {
      type: log ? "log" : "value", scale: true, min: log ? "dataMin" : null, max: log ? "dataMax" : null,
      name: title(column), nameLocation: "middle", nameGap: extra.gap, ...extra.own,
      axisTick: { customValues }, axisLabel: { formatter: (value) => short(value), customValues, hideOverlap: true },
    };
  };
  const palette = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#666666", "#F0E442"];
  const scale = ["#440154", "#3B528B", "#21918C", "#5EC962", "#FDE725"];
  // A colour of the continuous scale, from 0 to 1.
  const shade = (share) => {
    const at = Math.min(Math.floor(share * (scale.length - 1)), scale.length - 2);
    const part = share * (scale.length - 1) - at;
    const channel = (text, place) => parseInt(text.slice(place, place + 2), 16);
    return `rgb(${[1, 3, 5].map((place) => Math.round(channel(scale[at], place) * (1 - part) + channel(scale[at + 1], place) * part)).join(",")})`;
  };
  const symbols = ["circle", "triangle", "rect", "diamond"];

  const drawPlot = () => {
    const panels = [y.value, second[1].value, third[1].value].filter((name) => name);
    const X = columns.get(x.value);
    const colour = columns.get(by.value);
    const different = colour ? [...new Set(colour.values)] : [];
    const isContinuous = colour && isNumber(colour) && different.length > (join.checked ? MOST_JOINED : MOST_SERIES);
    const [least, most] = isContinuous ? extent(colour, (row) => isSettled(colour, row)) : [0, 1];
    // Rows without a value are last.
    const order = isContinuous || !colour ? [undefined] : different.sort((a, b) => (a === null) - (b === null)
      || (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b))));
    const coloured = order.filter((value) => value !== null).length;
    // More values than colours: numbers have a scale, and names another mark for each round of colours.
    const isScale = colour && isNumber(colour) && coloured > palette.length;
    const colourOf = (number) => order[number] === null ? GREY : isScale ? shade(number / (coloured - 1)) : palette[number % palette.length];
    const symbolOf = (number) => isScale ? symbols[0] : symbols[Math.floor(number / palette.length) % symbols.length];
    const inFull = (value) => value === undefined ? "" : order.filter((other) => short(other) === short(value)).length > 1 ? String(value) : short(value);
    const sources = study ? [...new Set(study.values)] : [null];
    const height = 78 / panels.length;
    const series = [];
    let without = 0;
    panels.forEach((name, panel) => {
      const Y = columns.get(name);
      const usable = (row) => X.values[row] !== null && Y.values[row] !== null
        && (!xLog.checked || X.values[row] > 0) && (!yLog.checked || Y.values[row] > 0);
      without += rows.filter((row) => !usable(row)).length;
      const add = (own, label, symbol, ink, source) => {
        if (!own.length) return;
        const joined = join.checked && !isContinuous && !isMeasured(own[0]);
        if (joined) own.sort((a, b) => X.values[a] - X.values[b]);
        series.push({
          name: label || name, type: joined ? "line" : "scatter", xAxisIndex: panel, yAxisIndex: panel,
          z: isMeasured(own[0]) ? 5 : 2, symbolSize: isMeasured(own[0]) ? 13 : rows.length > 1000 ? 4 : 8, symbol: isMeasured(own[0]) ? CROSS : symbol, color: ink,
          lineStyle: { type: ["solid", "dashed", "dotted"][source % 3] }, showSymbol: true, large: false, animation: false,
          data: own.map((row) => ({ value: isContinuous && ink === undefined ? [X.values[row], Y.values[row], colour.values[row]] : [X.values[row], Y.values[row]], row })),
        });
      };
      order.forEach((value, number) => {
        const own = rows.filter((row) => usable(row) && (value === undefined || colour.values[row] === value));
        sources.forEach((source, at) => {
          const there = own.filter((row) => !study || study.values[row] === source);
          if (!isContinuous) return add(there, inFull(value), symbolOf(number), colourOf(number), at);
          add(there.filter((row) => colour.values[row] !== null), "", "circle", undefined, at);
          add(there.filter((row) => colour.values[row] === null), `no ${colour.name}`, "circle", GREY, at);
        });
      });
    });
    left.textContent = without ? `${without} of ${rows.length * panels.length} points are not drawn: they have no value, or none above 0 for a logarithmic axis.` : "";
    chart.setOption({
      animation: false,
      backgroundColor: "transparent",
      tooltip: {
        trigger: "item",
        formatter: (event) => event.data && event.data.row !== undefined
          ? [...parameters, ...panels.map((name) => columns.get(name))].map((column) =>
            `${title(column)} = ${short(column.values[event.data.row])}`).map(echarts.format.encodeHTML).join("<br>") : "",
      },
      legend: colour && !isContinuous ? { type: "scroll", top: 0, left: 70, right: 120, formatter: (key) => `${colour.name} ${key}` } : undefined,
      toolbox: { right: 10, feature: { dataZoom: {}, restore: {}, saveAsImage: {} } },
      visualMap: isContinuous ? [{
        type: "continuous", dimension: 2, calculable: true, seriesIndex: series.flatMap((own, at) => own.color === undefined ? [at] : []), right: 0, top: "middle", text: [title(colour), ""],
        min: least, max: most, formatter: short, inRange: { color: scale },
      }] : [],
      grid: panels.map((_, panel) => ({ left: 80, right: isContinuous ? 130 : 30, top: `${10 + panel * (height + 3)}%`, height: `${height - 5}%` })),
      xAxis: panels.map((_, panel) => axisOf(X, xLog.checked, { gap: 28, own: { gridIndex: panel } })),
      yAxis: panels.map((name, panel) => axisOf(columns.get(name), yLog.checked, { gap: 58, own: { gridIndex: panel } })),
      dataZoom: [{ type: "inside", xAxisIndex: panels.map((_, panel) => panel), filterMode: "none" },
        { type: "inside", yAxisIndex: panels.map((_, panel) => panel), filterMode: "none" }],
      series,
    }, true);
  };

  const parallelScale = (column) => {
    const { type, min, max, scale, axisTick, axisLabel } = axisOf(column, isLog(column) && extent(column)[0] > 0, { gap: 0 });
    return { type, min, max, scale, axisTick, axisLabel };
  };
  const drawParallel = () => {
    const shown = [...parameters, columns.get(y.value), ...[second, third].map((own) => columns.get(own[1].value)).filter((own) => own)];
    const Y = columns.get(y.value);
    const [least, most] = extent(Y);
    chart.setOption({
      animation: false,
      backgroundColor: "transparent",
      parallel: { left: 80, right: 160, top: 50, bottom: 40, parallelAxisDefault: { nameTextStyle: { width: 140, overflow: "truncate" } } },
      parallelAxis: shown.map((column, dim) => isNumber(column)
        ? { dim, name: title(column), ...parallelScale(column) }
        : { dim, name: column.name, type: "category", data: [...new Set(column.values.map(short))] }),
      visualMap: {
        type: "continuous", dimension: parameters.length, min: least, max: most, right: 0, top: "middle",
        text: [title(Y), ""], calculable: true, formatter: short, inRange: { color: scale },
      },
      series: [{
        type: "parallel", animation: false, lineStyle: { width: 1, opacity: rows.length > 1000 ? 0.15 : 0.5 }, progressive: 500,
        data: rows.filter((row) => Y.values[row] !== null)
          .map((row) => ({ value: shown.map((column) => isNumber(column) ? column.values[row] : short(column.values[row])), row })),
      }],
    }, true);
  };

  // The interval of confidence: a line with two ends.
  const interval = (_, api) => {
    const [low, high] = [1, 2].map((dim) => api.coord([api.value(dim), api.value(0)]));
    const line = (x1, y1, x2, y2) => ({ type: "line", shape: { x1, y1, x2, y2 }, style: { stroke: dark.matches ? "#eee" : "#222", lineWidth: 1.5 } });
    return { type: "group", children: [line(...low, ...high), ...[low, high].map(([x, y]) => line(x, y - 5, x, y + 5))] };
  };
  const drawImportance = () => {
    const of = data.importance.find((own) => own.of === y.value);
    if (!of) {
      chart.clear();
      left.textContent = `There is no index for ${y.value}; there are indices for ${data.importance.map((own) => own.of).join(", ")}.`;
      return;
    }
    const bars = [...of.bars].sort((a, b) => a.value - b.value);
    chart.setOption({
      animation: false,
      backgroundColor: "transparent",
      title: {
        text: `${of.kind} of the parameters for ${of.of} (${of.points} points)`, subtext: of.notes.join(" "),
        textStyle: { fontSize: 14, width: box.clientWidth - 40, overflow: "break" }, subtextStyle: { width: box.clientWidth - 40, overflow: "break" },
      },
      tooltip: {
        formatter: (event) => {
          const bar = bars[event.dataIndex];
          const interval = bar.interval ? ` (${bar.interval.map(short).join(" … ")})` : "";
          return echarts.format.encodeHTML(`${bar.name}: ${of.kind} ${short(bar.value)}${interval}`);
        },
      },
      grid: { left: Math.min(220, box.clientWidth / 3), right: 40, top: box.clientWidth < 600 ? 170 : 110, bottom: 50 },
      xAxis: { type: "value", name: of.kind, nameLocation: "middle", nameGap: 28 },
      yAxis: { type: "category", data: bars.map((bar) => bar.name), axisLabel: { width: Math.min(200, box.clientWidth / 3 - 20), overflow: "break" } },
      series: [
        { type: "bar", animation: false, itemStyle: { color: palette[5] }, data: bars.map((bar) => bar.value) },
        { type: "custom", z: 10, animation: false, renderItem: interval, encode: { x: [1, 2], y: 0 }, silent: true,
          data: bars.flatMap((bar, number) => bar.interval ? [[number, ...bar.interval]] : []) },
      ],
    }, true);
  };

  // The table sorts by a click on a head, and a field below it filters: `>0.3`, `<=5`, `1..10`, or a part of a text.
  const shownColumns = data.columns.filter((column) => column.kind === "parameter" || varies(column));
  const MOST_LINES = 250;
  let sortBy = null;
  let ascending = true;
  const filters = new Map();
  const passes = (value, filter) => {
    const range = filter.match(/^\s*(-?[\d.e+-]+)\s*\.\.\s*(-?[\d.e+-]+)\s*$/i);
    if (range) return value !== null && value >= Number(range[1]) && value <= Number(range[2]);
    const compared = filter.match(/^\s*(<=|>=|<|>|=)\s*(-?[\d.e+-]+)\s*$/i);
    if (compared && typeof value === "number") {
      const limit = Number(compared[2]);
      return { "<": value < limit, ">": value > limit, "<=": value <= limit, ">=": value >= limit, "=": value === limit }[compared[1]];
    }
    return String(value === null ? "" : value).toLowerCase().includes(filter.trim().toLowerCase());
  };
  const body = make("tbody");
  const note = make("p", { class: "note" });
  const fillTable = () => {
    let kept = rows.filter((row) => [...filters].every(([name, filter]) => !filter || passes(columns.get(name).values[row], filter)));
    if (sortBy) {
      const values = columns.get(sortBy).values;
      const compare = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
      // Rows without a value are last in either order.
      kept = kept.sort((a, b) => (values[a] === null) - (values[b] === null) || (ascending ? 1 : -1) * compare(values[a], values[b]));
    }
    body.replaceChildren(...kept.slice(0, MOST_LINES).map((row) => {
      const line = make("tr", { "data-row": row, tabindex: "0" }, ...shownColumns.map((column) => make("td", {}, short(column.values[row]))));
      const open = () => showJob(row);
      line.addEventListener("click", open);
      line.addEventListener("keydown", (event) => { if (event.key === "Enter") open(); });
      return line;
    }));
    note.textContent = kept.length > MOST_LINES
      ? `The first ${MOST_LINES} of ${kept.length} jobs: filter them.` : `${kept.length} of ${rows.length} jobs`;
  };
  const makeTable = () => {
    const head = make("tr");
    const fields = make("tr");
    for (const column of shownColumns) {
      const cell = make("th", { scope: "col", title: column.meaning }, title(column));
      cell.addEventListener("click", () => { ascending = sortBy === column.name ? !ascending : true; sortBy = column.name; fillTable(); });
      head.append(cell);
      const field = make("input", { "aria-label": `filter ${column.name}`, placeholder: isNumber(column) ? ">, <, a..b" : "text" });
      field.addEventListener("input", () => { filters.set(column.name, field.value); fillTable(); });
      fields.append(make("th", {}, field));
    }
    table.append(note, make("table", {}, make("thead", {}, head, fields), body));
  };

  const draw = () => {
    [...tabs.children].forEach((tab, number) => tab.setAttribute("aria-selected", String(views[number] === view)));
    const isTable = view === "table";
    box.hidden = isTable;
    controls.hidden = isTable;
    table.hidden = !isTable;
    left.hidden = isTable;
    if (isTable) {
      if (!table.childElementCount) makeTable();
      fillTable();
      return;
    }
    left.textContent = "";
    renew();
    ({ plot: drawPlot, "parallel coordinates": drawParallel, importance: drawImportance })[view]();
  };
  x.addEventListener("change", () => { xLog.checked = isLog(columns.get(x.value)); });
  for (const control of [x, y, by, second[1], third[1], xLog, yLog, join]) control.addEventListener("change", draw);
  dark.addEventListener("change", draw);
  new ResizeObserver(() => { if (chart && !box.hidden) chart.resize(); }).observe(box);
  if (numbers.length) draw();
})();
