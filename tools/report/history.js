// The page of tools/history.
'use strict';

const { points, metrics, changes } = data;
const commitOf = (point) => point.commit || 'commit unknown';
const isChanged = ({ key }) => changes.some((change) => change.metric === key);

document.getElementById('head').append(
  el('h1', null, 'History'),
  el('div', { class: 'facts' },
    el('span', null, el('b', null, points.length), ' suites, from ', points[0].name, ' to ', points[points.length - 1].name),
    el('span', null, el('b', null, changes.length), changes.length === 1 ? ' change of level' : ' changes of level'),
    data.left_out.length ? el('span', null, data.left_out.length + ' runs left out, as not all suites have them') : null));

const shown = el('p', { class: 'small' }, 'Point at a plot: the suite and its commit are named here.');
const show = (i) => { shown.textContent = points[i].name + ': commit ' + commitOf(points[i]); };
const plots = el('div', { class: 'plots' });
document.getElementById('page').append(el('h2', null, 'Figures over the suites'), shown,
  el('p', { class: 'small' }, 'Bars: 95 % interval of the mean over scenarios. Coloured ground: from a change on that ' +
    'lcs compare calls regressed, to the next change.'), plots);
for (const { key, means, halves } of [...metrics.filter(isChanged), ...metrics.filter((one) => !isChanged(one))]) {
  const own = changes.filter((change) => change.metric === key);
  const bands = own.flatMap((change, i) => change.worse
    ? [{ from: change.at, to: own[i + 1] ? own[i + 1].at : points.length - 1, kind: 'worse' }] : []);
  plots.append(plot({ title: key, x: points.map((_, i) => i), xName: 'suite', whole: true, bands, sync: 'history', onPoint: show,
    top: 1.05 * Math.max(1e-9, ...means.map((mean, i) => mean + halves[i])),
    series: [{ name: 'mean', values: means, style: 's1', spread: halves.map((half) => half || 0) }] }));
}
document.getElementById('page').append(el('h2', null, 'Changes'),
  changes.length === 0 ? el('p', null, 'No figure has changed its level.') : '');
for (const { metric, at, before, after, text } of changes) {
  document.getElementById('page').append(
    el('h3', null, metric + ' ' + digits(before) + ' → ' + digits(after)),
    el('p', null, 'From ', points[at - 1].name, ' ', el('code', null, commitOf(points[at - 1])), ' to ', points[at].name, ' ',
      el('code', null, commitOf(points[at])), '. By lcs compare (which commit: ',
      el('code', null, 'tools/bisect ' + points[at - 1].commit + ' ' + points[at].commit + ' --frames'), '):'),
    el('pre', { class: 'scroll' }, text));
}
