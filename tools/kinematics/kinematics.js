// Lays out the data of a study of the kinematics, with what plot.js gives it.
(() => {
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);

// ---- Rows of a table

/** Rows where each column has the value given; a row is an object. */
function rows(table, where) {
  const columns = data.tables[table];
  const names = Object.keys(columns);
  const found = [];
  for (let i = 0; i < columns[names[0]].length; i++) {
    if (Object.entries(where || {}).every(([name, value]) => columns[name][i] === value)) {
      found.push(Object.fromEntries(names.map((name) => [name, columns[name][i]])));
    }
  }
  return found;
}
const values = (table, column) => [...new Set(data.tables[table][column])];
const pick = (some, column) => some.map((row) => row[column]);

/** One curve a series: {name, style, dashed, where}; `y` of the rows that fit, by their `x`. */
function curves({ title, table, where, x, xName, y, series, ...more }) {
  const tables = series.map((s) => {
    const some = rows(table, { ...where, ...s.where }).filter((row) => !more.logX || row[x] > 0).sort((a, b) => a[x] - b[x]);
    return [pick(some, x), pick(some, s.y || y)];
  });
  const [xs, ...ys] = uPlot.join(tables);
  return plot({ title, x: xs, xName, ...more, series: series.map(({ name, style, dashed }, i) =>
    ({ name, style, dashed, values: ys[i] })) });
}

const ROTATIONS = [['as_printed', 'as printed', 's4'], ['first_order', 'first order', 's2'],
  ['homography', 'homography', 's1']];
const DEPTHS = [['reference', 'reference depth', 's4'], ['learnt', 'learnt V', 's2'], ['truth', 'true depth', 's1']];
const AXES = ['pan', 'tilt', 'roll'];
const LEAST = 1e-3;  // px: what is less lies on the axis

const plots = (...all) => el('div', { class: 'plots' }, ...all);
const section = (title, text, ...content) => el('section', null, el('h2', null, title),
  text === '' ? null : el('p', { class: 'quiet' }, text), ...content);

// ---- Sections

function answers() {
  const body = el('tbody', null, ...data.statements.map((s, i) => el('tr', null,
    el('td', { class: 'left' }, i > 0 && data.statements[i - 1].topic === s.topic ? '' : s.topic),
    el('td', { class: 'left' }, s.text),
    el('td', { class: 'left' }, s.verdict && el('span', { class: 'badge ' + (s.verdict.startsWith('yes') ? 'met' : 'unmet') },
      s.verdict.split(':')[0]), s.verdict.replace(/^\w+:/, '')))));
  const figures = rows('answer');
  return section('The answer', '', el('table', null,
    el('thead', null, el('tr', null, ...['', '', 'within ' + data.tolerance_px + ' px?'].map((t) => el('th', { class: 'left' }, t)))), body),
    el('details', null, el('summary', null, 'Each figure beside what theory expects'),
      el('div', { class: 'scroll' }, el('table', null,
        el('thead', null, el('tr', null, ...['figure', 'measured', 'expected', 'unit'].map((t) => el('th', null, t)))),
        el('tbody', null, ...figures.map((f) => el('tr', null, el('td', null, f.figure),
          el('td', null, figure(f.value)), el('td', null, figure(f.expected)), el('td', { class: 'left' }, f.unit))))))));
}
const figure = (value) => isNumber(value) ? (value !== 0 && Math.abs(value) < 0.01 ? value.toExponential(2)
  : String(Number(value.toPrecision(4)))) : '–';

function field() {
  if (!data.field_png) return null;
  return section('The field', 'How corners move until the next frame, and how the model says they do: what is '
    + 'fixed, each with the V it has learnt' + (data.has_movers ? '; right what moves, predicted as if it stood still' : '')
    + '. The cross is the focus of expansion.', el('img', { src: 'data:image/png;base64,' + data.field_png, style: 'width:100%',
      alt: 'true and predicted motion over a rendered frame' }));
}

function rotation() {
  const of = (points, axis, still) => curves({ title: axis + ', ' + points + (still ? ', turning only' : ', driving too'),
    table: 'rotation', where: { points, axis, depth: 'truth', step_m: still ? 0 : stepped }, x: 'angle_deg', xName: 'deg',
    y: 'p95_px', logY: true, bottom: LEAST,
    series: ROTATIONS.map(([key, name, style]) => ({ name, style, where: { rotation: key } })) });
  const stepped = Math.max(...data.tables.rotation.step_m);
  const withDepth = (axis) => curves({ title: axis + ', driving, homography', table: 'rotation',
    where: { points: 'rendered', axis, rotation: 'homography', step_m: stepped }, x: 'angle_deg', xName: 'deg',
    y: 'p95_px', logY: true, bottom: LEAST,
    series: DEPTHS.map(([key, name, style]) => ({ name, style, where: { depth: key } })) });
  return section('Turning', 'End-point error, px (95 of 100 points are within it), over the turn in a frame; by powers '
    + 'of ten, what is below ' + LEAST + ' lies on the axis.',
    plots(...AXES.map((axis) => of('geometric', axis, true)), ...AXES.map((axis) => of('rendered', axis, true)),
      ...AXES.map((axis) => of('rendered', axis, false)), ...AXES.map(withDepth)));
}

function translation() {
  const depths = values('translation', 'depth_m').filter((m) => rows('translation', { points: 'geometric', depth_m: m }).length);
  const bySource = (where, title) => curves({ title, table: 'translation', where, x: 'step_over_depth',
    xName: 'speed / (rate x depth)', y: 'median_px', logX: true, logY: true, bottom: LEAST,
    series: DEPTHS.map(([key, name, style]) => ({ name, style, where: { depth: key } })) });
  const foe = (points, what, series, where) => curves({ title: what + ', ' + points, table: 'foe_distance',
    where: { points, ...where }, x: 'from_px', xName: 'px from the FOE', y: 'median_px', logY: true, bottom: LEAST, series });
  const byDepth = DEPTHS.map(([key, name, style]) => ({ name, style, where: { depth: key } }));
  const byRotation = ROTATIONS.map(([key, name, style]) => ({ name, style, where: { rotation: key } }));
  return section('Driving', 'Median end-point error, px. The step of the camera in a frame, speed / rate, is a share of '
    + 'the depth; a step that brings points to the reference depth of ' + data.reference_depth_m + ' m '
    + 'makes it right by chance, and its error dives. Below, at the nominal speed and while panning by 1 deg, over the distance from the focus of expansion.',
    plots(bySource({ points: 'rendered' }, 'rendered corners'),
      ...depths.slice(0, 5).map((m) => bySource({ points: 'geometric', depth_m: m }, 'points at ' + m + ' m')),
      ...['geometric', 'rendered'].flatMap((points) => [
        foe(points, 'homography', byDepth, { rotation: 'homography' }),
        foe(points, 'true depth', byRotation, { depth: 'truth' })])));
}

function focal() {
  const styles = { pan: 's1', tilt: 's2', roll: 's3' };
  const limits = (points) => curves({ title: 'first order within ' + data.tolerance_px + ' px, ' + points, table: 'focal_length',
    where: { points }, x: 'focal_px', xName: 'px of focal length', logX: true,
    series: [...AXES.map((axis) => ({ name: axis, style: styles[axis], y: 'first_order_limit_' + axis + '_deg' })),
      ...AXES.map((axis) => ({ name: 'theory', style: styles[axis], dashed: true, y: 'theory_limit_' + axis + '_deg' }))] });
  return section('Focal length', 'The largest turn in a frame, deg, at which first order is within ' + data.tolerance_px + ' px at all points; '
    + 'and the median error of V, px, at the nominal speed.', plots(limits('geometric'), limits('rendered'),
    ...['geometric', 'rendered'].map((points) => curves({ title: 'V, ' + points, table: 'focal_length', where: { points },
      x: 'focal_px', xName: 'px of focal length', logX: true, logY: true, bottom: 1e-2,
      series: [{ name: 'reference depth', style: 's4', y: 'reference_median_px' },
        { name: 'learnt V', style: 's2', y: 'learnt_median_px' }] }))));
}

function mount() {
  const styles = { pan: 's1', tilt: 's2', roll: 's3' };
  const of = (points, pan_deg) => curves({ title: points + (pan_deg ? ', panning by ' + pan_deg + ' deg' : ', straight on'),
    table: 'mount', where: { points, pan_deg }, x: 'error_deg', xName: 'deg off', y: 'rms_px',
    series: AXES.map((axis) => ({ name: axis, style: styles[axis], where: { axis } })) });
  return section('Mount', 'Root mean square error, px, of the exact model with the true depth where the camera looks '
    + 'elsewhere than the filter was told.', plots(...['geometric', 'rendered'].flatMap((points) =>
    values('mount', 'pan_deg').map((pan) => of(points, pan)))));
}

function imu() {
  const styles = ['s1', 's2', 's3', 's5', 's4'];
  const names = values('imu', 'imu').filter((name) => name !== 'ideal');
  const of = (odometry) => curves({ title: odometry === 'yes' ? 'with odometry' : 'IMU alone', table: 'imu',
    where: { odometry }, x: 'rate_hz', xName: 'frames/s', y: 'rms_px', logX: true, logY: true, bottom: 1e-2,
    series: names.flatMap((name, i) => [{ name, style: styles[i], where: { imu: name } },
      { name: 'expected', style: styles[i], dashed: true, where: { imu: name }, y: 'expected_rms_px' }]) });
  const turn = curves({ title: 'rotation alone', table: 'imu', where: { odometry: 'no' }, x: 'rate_hz', xName: 'frames/s',
    y: 'rotation_rms_px', logX: true, logY: true, bottom: 1e-2, series: names.flatMap((name, i) => [
      { name, style: styles[i], where: { imu: name } },
      { name: 'expected', style: styles[i], dashed: true, where: { imu: name }, y: 'expected_rotation_rms_px' }]) });
  return section('IMU', 'Root mean square error, px, of the exact model with the true depth, over the first seconds from '
    + 'a known start, straight on; dashed what theory expects.', plots(of('no'), of('yes'), turn));
}

function bumps() {
  const way = (name, style, rotation, told_by) => ({ name, style, where: { rotation, told_by } });
  return section('Bumps', 'On wheels over rough ground: how much the camera turns in a frame, and the root mean square '
    + 'error, px, that each way to take the rotation out leaves.', plots(
    curves({ title: 'turn in a frame, deg', table: 'bumps', where: { rotation: 'none' }, x: 'roughness_m', xName: 'm of roughness',
      series: [{ name: 'median', style: 's1', y: 'turn_median_deg' }, { name: '95 of 100', style: 's2', y: 'turn_p95_deg' },
        { name: 'most', style: 's4', y: 'turn_max_deg' }] }),
    curves({ title: 'error, px', table: 'bumps', x: 'roughness_m', xName: 'm of roughness', y: 'rms_px', logY: true, bottom: LEAST,
      series: [way('left in', 's5', 'none', 'truth'), way('as printed', 's4', 'as_printed', 'truth'),
        way('first order', 's2', 'first_order', 'truth'), way('homography', 's1', 'homography', 'truth'),
        way('homography, told by the IMU', 's3', 'homography', 'imu')] })));
}

function drives() {
  const body = rows('drives').reduce((all, row) => {
    const key = row.drive + '|' + row.told_by + '|' + row.rotation;
    (all[key] = all[key] || {})[row.depth] = row;
    return all;
  }, {});
  const cell = (row) => el('td', null, digits(row.median_px), el('span', { class: 'spread' }, digits(row.p95_px)));
  return section('Rendered drives', 'The filter’s own landmarks against the simulator’s truth: median error, px, and '
    + 'beside it what 95 of 100 are within. V is what the filter has learnt.', el('div', { class: 'scroll' }, el('table', null,
    el('thead', null, el('tr', null, ...['drive', 'motion told by', 'rotation', ...DEPTHS.map(([, name]) => name)].map((t, i) =>
      el('th', { class: i < 3 ? 'left' : null }, t)))),
    el('tbody', null, ...Object.values(body).map((by) => el('tr', null, ...['drive', 'told_by', 'rotation'].map((column) =>
      el('td', { class: 'left' }, by.truth[column].replace('_', ' '))), ...DEPTHS.map(([key]) => cell(by[key]))))))));
}

function drift() {
  const styles = { no: 's4', yes: 's1' };
  const of = (name, what, unit) => curves({ title: name + ': ' + what.replace(/_.*/, '') + ', ' + unit, table: 'drift', where: { imu: name },
    x: 't_s', xName: 's', logY: true, bottom: what.includes('rad') ? 1e-5 : 1e-4,
    series: ['no', 'yes'].flatMap((odometry) => [
      { name: odometry === 'yes' ? 'with odometry' : 'IMU alone', style: styles[odometry], where: { odometry }, y: what },
      { name: 'expected', style: styles[odometry], dashed: true, where: { odometry }, y: 'expected_' + what }]) });
  const names = values('drift', 'imu').filter((name) => name !== 'ideal');
  return section('Drift', 'Root mean square error of attitude and velocity over time from a known start, straight on; '
    + 'dashed what theory expects.', plots(...names.flatMap((name) => [of(name, 'forward_mps', 'm/s'),
    of(name, 'lateral_mps', 'm/s'), of(name, 'vertical_mps', 'm/s'), of(name, 'tilt_rad', 'rad'), of(name, 'heading_rad', 'rad')])));
}

// ---- Heat maps

/** From light to dark; the greatest value is the darkest. */
function heatColour(share) {
  return `hsl(${215 - 215 * share} 75% ${88 - 50 * share}%)`;
}

function heatMap(map) {
  const cell = 480 / map.columns, height = cell * map.rows;
  const known = map.errors_px.filter(isNumber);
  const most = Math.max(...known), least = Math.min(...known);
  const readout = el('div', { class: 'readout' });
  const cells = map.errors_px.map((error, i) => !isNumber(error) ? null : svg('rect', {
    x: (i % map.columns * cell).toFixed(2), y: (Math.floor(i / map.columns) * cell).toFixed(2),
    width: (cell + 0.3).toFixed(2), height: (cell + 0.3).toFixed(2), fill: heatColour(most > 0 ? error / most : 0),
    onpointerenter: () => { readout.textContent = figure(error) + ' px'; } }));
  return el('figure', { class: 'plot' }, el('figcaption', null, el('b', null, map.name),
    el('span', null, figure(least) + ' to ' + figure(most) + ' px')),
  svg('svg', { viewBox: `0 0 480 ${height}`, role: 'img', 'aria-label': map.name }, ...cells), readout);
}
const heat = () => section('Over the image', 'Error in each part of the image, from blue (0) to red (the most); a blank '
  + 'is where no point stays in the image.', plots(...data.heat.map(heatMap)));

// ---- The page

document.getElementById('head').append(el('h1', null, 'When does the kinematics model hold?'),
  el('p', { class: 'quiet' }, data.subject), el('p', null, el('b', null, data.bottom_line)));
document.getElementById('page').append(...[answers(), field(), rotation(), translation(), heat(), focal(), mount(), imu(),
  bumps(), drives(), drift()].filter(Boolean));
})();
