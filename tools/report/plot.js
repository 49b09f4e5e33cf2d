// Elements, numbers and plots for pages. Text from outside goes in as text nodes alone, never as HTML.
'use strict';

// ---- Elements

/** An element; attributes that are null are left out, children that are null too. */
function el(tag, attributes, ...children) {
  return fill(document.createElement(tag), attributes, children);
}
function svg(tag, attributes, ...children) {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}
function fill(node, attributes, children) {
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

// ---- Numbers

const isNumber = (value) => typeof value === 'number';

function digits(value) {
  if (!isNumber(value)) return '–';
  const size = Math.abs(value);
  const decimals = size === 0 ? 0 : size < 10 ? 2 : size < 100 ? 1 : 0;
  if (size > 0 && size < 0.005) return value.toPrecision(1).replace('-', '−');
  return value.toFixed(decimals).replace('-', '−');
}

// ---- Plots

const WIDTH = 480, HEIGHT = 190, LEFT = 40, RIGHT = 10, TOP = 8, BOTTOM = 24;

function ticks(low, high, about) {
  const raw = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw);
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) all.push(i * step);
  return all;
}
const tickText = (value) => value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(0)
  : String(Number(value.toPrecision(6)));

/** Points joined where none is missing between them; a lone one as a dot. */
function curve(xs, ys, at, style) {
  const parts = [];
  let path = '', count = 0, last = null;
  const end = () => {
    if (count > 1) parts.push(svg('path', { class: 'curve ' + style, d: path }));
    if (count === 1) parts.push(svg('circle', { class: 'dot ' + style, cx: last[0], cy: last[1], r: 1.8 }));
    path = '';
    count = 0;
  };
  xs.forEach((x, i) => {
    if (!isNumber(ys[i])) return end();
    last = [at.x(x).toFixed(1), at.y(ys[i]).toFixed(1)];
    path += (count++ ? 'L' : 'M') + last.join(' ');
  });
  end();
  return parts;
}

/** The share of the way from low to high, and the round values between them. */
function linear(low, high, about) {
  return { share: (value) => high > low ? (value - low) / (high - low) : 0.5,
    ticks: ticks(low, high > low ? high : low + 1, about) };
}
/** Likewise by powers of ten; what is smaller than low lies on it. */
function logarithmic(low, high) {
  const from = Math.log10(low), decades = Math.max(1e-9, Math.log10(high) - from);
  const all = [];
  for (let power = Math.floor(from); power <= from + decades; power++) {
    for (const factor of decades < 2 ? [1, 2, 5] : [1]) {
      const value = factor * 10 ** power;
      if (value >= low * 0.999 && value <= high * 1.001) all.push(value);
    }
  }
  return { share: (value) => (Math.log10(Math.max(value, low)) - from) / decades, ticks: all };
}

/**
 * series: {name, values, style, dashed, spread}; a band is {from, to, kind, title}.
 * logX and logY: by powers of ten, y from `bottom` up.
 * Pointing at the plot reads the values there.
 */
function plot({ title, x, xName, series, top, bands, logX, logY, bottom }) {
  const low = Math.min(...x), high = Math.max(...x);
  const values = series.flatMap((s) => s.values).filter(isNumber);
  const greatest = top || Math.max(1e-9, ...values) * 1.05;
  const scale = {
    x: logX ? logarithmic(low, high) : linear(low, high, 6),
    y: logY ? logarithmic(bottom, Math.max(greatest, 10 * bottom)) : linear(0, greatest, 4),
  };
  const at = {
    x: (value) => LEFT + scale.x.share(value) * (WIDTH - LEFT - RIGHT),
    y: (value) => HEIGHT - BOTTOM - scale.y.share(value) * (HEIGHT - TOP - BOTTOM),
  };
  const cursor = svg('line', { class: 'cursor', y1: TOP, y2: HEIGHT - BOTTOM });
  const picture = svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img',
    'aria-label': title + ' over ' + xName + ': ' + series.map((s) => s.name).join(', ') },
    ...(bands || []).map((band) => svg('rect', { class: 'band ' + band.kind, x: at.x(band.from) - 1, y: TOP,
      width: Math.max(2, at.x(band.to) - at.x(band.from) + 2), height: HEIGHT - TOP - BOTTOM },
      svg('title', null, band.title))),
    ...scale.y.ticks.flatMap((value) => [
      svg('line', { class: 'grid', x1: LEFT, x2: WIDTH - RIGHT, y1: at.y(value), y2: at.y(value) }),
      svg('text', { x: LEFT - 5, y: at.y(value) + 4, 'text-anchor': 'end' }, tickText(value))]),
    ...scale.x.ticks.filter((value) => at.x(value) <= WIDTH - RIGHT - 8 * xName.length - 12).map((value) =>
      svg('text', { x: at.x(value), y: HEIGHT - 7, 'text-anchor': 'middle' }, tickText(value))),
    svg('text', { x: WIDTH - RIGHT, y: HEIGHT - 7, 'text-anchor': 'end' }, xName),
    ...series.flatMap((s) => curve(x, s.values, at, s.style + (s.dashed ? ' dashed' : ''))),
    ...series.filter((s) => s.spread).flatMap((s) => x.flatMap((value, i) => isNumber(s.values[i]) ? [
      svg('circle', { class: 'dot ' + s.style, cx: at.x(value), cy: at.y(s.values[i]), r: 3 }),
      svg('line', { class: 'whisker ' + s.style, x1: at.x(value), x2: at.x(value),
        y1: at.y(s.values[i] - (s.spread[i] || 0)), y2: at.y(s.values[i] + (s.spread[i] || 0)) })] : [])),
    cursor);
  const readout = el('div', { class: 'readout' });
  const read = (event) => {
    const box = picture.getBoundingClientRect();
    const px = (event.clientX - box.left) / box.width * WIDTH;
    let nearest = 0;
    x.forEach((value, i) => { if (Math.abs(at.x(value) - px) < Math.abs(at.x(x[nearest]) - px)) nearest = i; });
    cursor.setAttribute('x1', at.x(x[nearest]));
    cursor.setAttribute('x2', at.x(x[nearest]));
    cursor.style.visibility = 'visible';
    readout.textContent = tickText(x[nearest]) + ' ' + xName + ':  ' +
      series.map((s) => s.name + ' ' + digits(s.values[nearest])).join(',  ');
  };
  picture.addEventListener('pointermove', read);
  picture.addEventListener('pointerleave', () => { cursor.style.visibility = 'hidden'; readout.textContent = ''; });
  return el('figure', { class: 'plot' },
    el('figcaption', null, el('b', null, title), ...series.map((s) =>
      el('span', { class: 'key ' + s.style + (s.dashed ? ' dashed' : '') }, el('span', null, s.name))),
      ...[['miss', 'missed'], ['false', 'false alarm']].filter(([kind]) => (bands || []).some((b) => b.kind === kind))
        .map(([kind, name]) => el('span', { class: 'key ' + kind }, el('span', null, name)))),
    picture, readout);
}
