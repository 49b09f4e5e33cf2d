// Elements, numbers and plots for pages. External text is only inserted as text nodes, never as HTML.
'use strict';

/** What the page is to show. */
const data = JSON.parse(document.getElementById('data').textContent);

// ---- Elements

/** Makes an element. Attributes and children that are null are omitted. */
function el(tag, attributes, ...children) {
  const node = ['svg', 'g', 'image', 'line', 'path'].includes(tag) ? document.createElementNS('http://www.w3.org/2000/svg', tag)
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value);
  }
  for (const child of children.flat()) {
    if (child !== null && child !== undefined) node.append(child);
  }
  return node;
}

/** A table of `rows`, which scrolls where it is wide. Each of `heads` is a cell or its text. */
const table = (attributes, heads, rows, caption) => el('div', { class: 'scroll' },
  el('table', attributes, caption, el('thead', null, el('tr', null,
    ...heads.map((head) => typeof head === 'string' ? el('th', null, head) : head))),
    el('tbody', null, ...rows)));

// ---- Numbers

const isNumber = (value) => typeof value === 'number';

function digits(value) {
  if (!isNumber(value)) return '–';
  const size = Math.abs(value);
  const decimals = size === 0 ? 0 : size < 10 ? 2 : size < 100 ? 1 : 0;
  if (size > 0 && size < 0.005) return value.toPrecision(1).replace('-', '−');
  return value.toFixed(decimals).replace('-', '−');
}

const tickText = (value) => value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(0)
  : String(Number(value.toPrecision(6)));

// ---- Plots, by uPlot

const HEIGHT = 170;
const BANDS = { miss: { name: 'missed', style: 's2' }, false: { name: 'false alarm', style: 's5' },
  worse: { name: 'worse level', style: 's5' } };

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name);

/** Indices of values without neighbouring values, which no line would show. */
const loneOnes = (values) => values.flatMap((v, i) =>
  v !== null && !isNumber(values[i - 1]) && !isNumber(values[i + 1]) ? [i] : []);

/**
 * x: in ascending order. series: {name, values, style, dashed, faint, spread}; a band is {from, to, kind}.
 * whole: x has whole numbers. logX and logY: logarithmic scales; y begins at `bottom`, to which lower values are raised.
 * Pointing at the plot shows the values there, in all plots of the same `sync`, and calls `onPoint` with x's index.
 * `pointAt(value of x)` of the returned figure points at that value in this plot.
 */
function plot({ title, x, xName, series, top, bands = [], whole, logX, logY, bottom, sync, onPoint }) {
  const low = x[0], high = x[x.length - 1];
  const shown = series.map((s) => s.values.map((v) => !isNumber(v) ? null : logY ? Math.max(v, bottom) : v));
  const greatest = top || shown.flat().reduce((most, v) => Math.max(most, v), 1e-9) * 1.05;
  const scale = (log, range) => ({ time: false, distr: log ? 3 : 1, range: () => range });
  const axis = (more) => ({ stroke: () => colour('quiet'), font: '11px system-ui, sans-serif', ticks: { show: false },
    values: (_, ticks) => ticks.map((v) => v === null ? '' : tickText(v)), ...more });
  const drawBands = ({ ctx, bbox, valToPos }) => {
    ctx.save();
    ctx.globalAlpha = 0.2;
    for (const [kind, { style }] of Object.entries(BANDS)) {
      ctx.fillStyle = colour(style);
      ctx.beginPath();  // one path for all, so that overlapping bands are not darker
      for (const band of bands.filter((b) => b.kind === kind)) {
        const from = valToPos(band.from, 'x', true), to = valToPos(band.to, 'x', true);
        ctx.rect(from - 1, bbox.top, to - from + 2, bbox.height);
      }
      ctx.fill();
    }
    ctx.restore();
  };
  const drawSpreads = ({ ctx, valToPos }) => series.forEach((s) => (s.spread || []).forEach((spread, i) => {
    if (!isNumber(s.values[i])) return;
    ctx.strokeStyle = colour(s.style);
    ctx.beginPath();
    for (const end of [-spread, spread]) ctx.lineTo(valToPos(x[i], 'x', true), valToPos(s.values[i] + end, 'y', true));
    ctx.stroke();
  }));
  const chart = new uPlot({ width: 480, height: HEIGHT,
    scales: { x: scale(logX, [low, high > low ? high : low + 1]),
      y: scale(logY, logY ? [bottom, Math.max(greatest, 10 * bottom)] : [0, greatest]) },
    axes: [axis({ size: 26, grid: { show: false }, ...(whole && { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500] }) }), axis({ size: 44, grid: { stroke: () => colour('line'), width: 1,
      filter: (_, ticks) => logY ? ticks.map((v) => Number.isInteger(Number(Math.log10(v).toFixed(6))) ? v : null) : ticks } })],
    legend: { markers: { width: 2, dash: (_, i) => !series[i - 1] ? 'none' : series[i - 1].faint ? 'dotted' : series[i - 1].dashed ? 'dashed' : 'solid' } },
    cursor: { y: false, drag: { x: false }, sync: sync ? { key: sync } : undefined },
    series: [{ label: xName, value: (_, v) => v === null ? '' : tickText(v) },
      ...series.map((s, i) => ({ label: s.name, stroke: () => colour(s.style), width: s.faint ? 1 : 1.6,
        dash: s.dashed ? [5, 4] : s.faint ? [2, 3] : undefined,
        value: (_, v, __, at) => at === null ? '' : digits(s.values[at]),
        points: { show: Boolean(s.spread), size: 5, filter: s.spread ? undefined : () => loneOnes(shown[i]) } }))],
    hooks: { drawClear: [drawBands], draw: [drawSpreads],
      setCursor: [({ cursor }) => { if (onPoint && isNumber(cursor.idx)) onPoint(cursor.idx); }] },
  }, [x, ...shown]);
  chart.root.setAttribute('role', 'img');
  chart.root.setAttribute('aria-label', title + ' over ' + xName + ': ' + series.map((s) => s.name).join(', '));
  const figure = el('figure', { class: 'plot' }, el('figcaption', null, el('b', null, title),
    ...Object.entries(BANDS).filter(([kind]) => bands.some((b) => b.kind === kind))
      .map(([kind, { name }]) => el('span', { class: 'key ' + kind }, name))), chart.root);
  figure.pointAt = (value) => chart.setCursor({ left: chart.valToPos(value, 'x'), top: 1 });
  const fit = () => { if (figure.clientWidth > 0) chart.setSize({ width: figure.clientWidth, height: HEIGHT }); };
  new ResizeObserver(() => requestAnimationFrame(fit)).observe(figure);
  return figure;
}
