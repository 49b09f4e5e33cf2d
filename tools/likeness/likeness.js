// Lays out what corners see in worlds, the suite and recordings, with what plot.js gives it.
(() => {
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
const groups = data.groups.filter((group) => group.pairs > 0);
const worlds = data.groups[0];
const STYLES = { world: 's1', suite: 's3', recording: 's2' };
const [LOW, FIRST, MEDIAN, THIRD, HIGH] = [0, 1, 2, 3, 4];

/** A bar for each group: the line holds 80 pictures in 100, the bar 50, the tick is the median. */
function bars(measure, m) {
  const shown = groups.filter((group) => group.quantiles[m].length);
  const all = shown.flatMap((group) => group.quantiles[m]);
  if (!all.length) return null;
  const names = 118, row = 17, foot = TOP + row * shown.length + 4, height = foot + 18;
  const least = Math.min(...all), most = Math.max(...all);
  const positive = all.filter((value) => value > 0);
  const scale = measure.by_factors && positive.length && most > 0
    ? logarithmic(Math.min(...positive), Math.max(most, 2 * Math.min(...positive)))
    : linear(least, most, 6);
  const x = (value) => names + scale.share(value) * (WIDTH - names - RIGHT);
  const span = (group, from, to, y, thick, title) => svg('line', { class: 'whisker ' + STYLES[group.origin],
    x1: x(group.quantiles[m][from]) - (thick > 1 ? 0.5 : 0), x2: x(group.quantiles[m][to]) + (thick > 1 ? 0.5 : 0),
    y1: y, y2: y, style: 'stroke-width:' + thick }, svg('title', null, title));
  return el('figure', { class: 'plot' }, el('figcaption', null, el('b', null, measure.name), measure.about),
    svg('svg', { viewBox: `0 0 ${WIDTH} ${height}`, role: 'img', 'aria-label': measure.name },
      worlds.quantiles[m].length ? svg('rect', { class: 'band miss', x: x(worlds.quantiles[m][LOW]), y: TOP,
        width: Math.max(1, x(worlds.quantiles[m][HIGH]) - x(worlds.quantiles[m][LOW])), height: foot - TOP }) : null,
      ...scale.ticks.map((value) => svg('text', { x: x(value), y: height - 4, 'text-anchor': 'middle' },
        tickText(value))),
      ...shown.flatMap((group, i) => {
        const y = TOP + row * (i + 0.5), title = group.name + ': ' + group.quantiles[m].map(digits).join(', ');
        const median = x(group.quantiles[m][MEDIAN]);
        return [svg('text', { x: names - 6, y: y + 4, 'text-anchor': 'end' }, group.name),
          span(group, LOW, HIGH, y, 1, title), span(group, FIRST, THIRD, y, 6, title),
          svg('line', { class: 'cursor', x1: median, x2: median, y1: y - 6, y2: y + 6,
            style: 'visibility:visible;stroke-width:2;stroke:var(--text)' })];
      })));
}

function table() {
  const cell = (group, m) => {
    const q = group.quantiles[m];
    if (!q.length) return el('td', null, '–');
    return el('td', { class: group.outside[m] ? 'bad' : null }, digits(q[MEDIAN]),
      el('span', { class: 'change' }, digits(q[LOW]) + ' to ' + digits(q[HIGH])));
  };
  return el('div', { class: 'scroll' }, el('table', null,
    el('thead', null, el('tr', null, ...['', 'runs', 'pairs', ...data.measures.map((m) => m.name)].map((name) =>
      el('th', null, name)))),
    el('tbody', null, ...groups.map((group) => el('tr', null, el('td', null, group.name), el('td', null, group.runs),
      el('td', null, group.pairs), ...data.measures.map((_, m) => cell(group, m)))))));
}

document.getElementById('head').append(el('h1', null, 'Are the worlds like the world?'),
  el('p', { class: 'quiet' }, 'Each pair of neighbouring pictures gives one number a measure; those of corners are '
    + 'medians over its corners. Lines hold 80 pairs in 100, bars 50, ticks are medians; behind them what 80 in 100 '
    + 'pairs of all worlds have.'));
document.getElementById('page').append(el('div', { class: 'plots' }, ...data.measures.map(bars).filter(Boolean)),
  el('h2', null, 'Medians, and what 80 pairs in 100 have'),
  el('p', { class: 'quiet' }, 'Red: the median of a recording that is outside of that of the worlds.'), table());
})();
