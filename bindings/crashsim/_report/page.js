// Draws the figures in the page's colours, follows dark and light, prints in light, sorts tables.
(() => {
  "use strict";

  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: "hover",
    modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
    showSendToCloud: false, // no curve leaves this file
    plotlyServerURL: "",
    toImageButtonOptions: { format: "svg" },
  };
  const paper = { width: 322, height: 215, margin: { l: 46, r: 10, t: 18, b: 36 } }; // half a page of A4
  const figures = [];

  const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  const isPrinting = () => document.documentElement.dataset.theme === "light";

  function translucent(hex) {
    const part = (from) => parseInt(hex.slice(from, from + 2), 16);
    return `rgba(${part(1)}, ${part(3)}, ${part(5)}, 0.45)`;
  }

  function colorTrace(trace) {
    const own = color(trace.meta.color);
    trace.line.color = own;
    if (trace.marker) Object.assign(trace.marker, { color: own, line: { ...trace.marker.line, color: own } });
    if (trace.error_y) trace.error_y.color = own;
    if (trace.stackgroup) trace.fillcolor = translucent(own);
  }

  function colorLayout(layout) {
    const [text, faint, grid] = [color("text"), color("faint"), color("grid")];
    layout.dragmode = matchMedia("(hover: hover)").matches ? "zoom" : false; // a finger scrolls the page
    layout.paper_bgcolor = layout.plot_bgcolor = "rgba(0,0,0,0)";
    layout.font = { family: getComputedStyle(document.body).fontFamily, size: isPrinting() ? 9 : 12, color: text };
    layout.hoverlabel = { bgcolor: color("raised"), bordercolor: faint, font: { color: text }, namelength: 40 };
    layout.modebar = { bgcolor: "rgba(0,0,0,0)", color: faint, activecolor: text };
    for (const axis of [layout.xaxis, layout.yaxis]) {
      Object.assign(axis, { gridcolor: grid, zerolinecolor: faint, linecolor: faint, tickcolor: faint, ticks: "outside" });
    }
    for (const shape of layout.shapes ?? []) shape.line.color = faint;
    for (const annotation of layout.annotations ?? []) annotation.font = { size: isPrinting() ? 8 : 11, color: faint };
  }

  function draw(figure) {
    figure.data.forEach(colorTrace);
    colorLayout(figure.layout);
    return Plotly.react(figure.plot, figure.data, figure.layout, config);
  }

  function bindLegend(figure, element) {
    for (const button of element.querySelectorAll(".legend button")) {
      button.addEventListener("click", () => {
        const trace = figure.data[Number(button.dataset.curve)];
        const isShown = trace.visible === false;
        trace.visible = isShown;
        button.setAttribute("aria-pressed", String(isShown));
        draw(figure);
      });
    }
  }

  function makeFigures() {
    for (const element of document.querySelectorAll("main figure[id]")) {
      const specification = JSON.parse(element.querySelector("script[type='application/json']").textContent);
      const figure = { plot: element.querySelector(".plot"), ...specification };
      figures.push(figure);
      bindLegend(figure, element);
    }
    return Promise.all(figures.map(draw));
  }

  function forPrint() {
    document.documentElement.dataset.theme = "light";
    for (const figure of figures) {
      figure.screenMargin = figure.layout.margin;
      Object.assign(figure.layout, paper);
      draw(figure);
    }
  }

  function forScreen() {
    delete document.documentElement.dataset.theme;
    for (const figure of figures) {
      delete figure.layout.width;
      delete figure.layout.height;
      figure.layout.margin = figure.screenMargin;
      draw(figure).then(() => Plotly.Plots.resize(figure.plot));
    }
  }

  function compare(a, b) {
    const [left, right] = [Number(a), Number(b)];
    if (!Number.isNaN(left) && !Number.isNaN(right)) return left - right;
    return a.localeCompare(b, "en", { numeric: true });
  }

  function reorder(rows) {
    for (const list of document.querySelectorAll(".multiples ul")) {
      const items = new Map([...list.children].map((item) => [item.dataset.case, item]));
      list.append(...rows.map((row) => items.get(row.dataset.case)));
    }
  }

  function sortBy(table, head) {
    const isDescending = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", isDescending ? "descending" : "ascending");
    const value = (row) => row.cells[head.cellIndex].dataset.value;
    const rows = [...table.tBodies[0].rows].sort((a, b) => {
      const [left, right] = [value(a), value(b)];
      if (left === "" || right === "") return (left === "") - (right === "");
      return isDescending ? compare(right, left) : compare(left, right);
    });
    table.tBodies[0].append(...rows);
    reorder(rows);
  }

  function makeSortable() {
    for (const table of document.querySelectorAll("table.sortable")) {
      for (const head of table.tHead.rows[0].cells) {
        head.querySelector("button").addEventListener("click", () => sortBy(table, head));
      }
    }
  }

  makeSortable();
  makeFigures().then(() => {
    document.documentElement.dataset.drawn = "true";
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => figures.forEach(draw));
  addEventListener("beforeprint", forPrint);
  addEventListener("afterprint", forScreen);
})();
