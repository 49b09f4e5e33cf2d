// Lays out a study of the kinematics as tables and plots, with the elements of plot.js.
(() => {
'use strict';

// ---- Tables

/** The lines of a CSV text as objects; an empty cell becomes null. */
function parsed(csv) {
  const [names, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
  const value = (cell) => cell === '' ? null : isNaN(cell) ? cell : Number(cell);
  return lines.map((cells) => Object.fromEntries(names.map((name, i) => [name, value(cells[i])])));
}
const tables = Object.fromEntries(Object.entries(data.tables).map(([name, csv]) => [name, parsed(csv)]));

/** The rows of a table in which each column has the given value. */
const rows = (table, where) => tables[table].filter((row) =>
  Object.entries(where || {}).every(([column, value]) => row[column] === value));
const values = (table, column) => [...new Set(tables[table].map((row) => row[column]))];

const left = (tag, cells) => cells.map((cell) => el(tag, { class: 'left' }, cell));
const leftTable = (heads, lines) => table(null, left('th', heads),
  lines.map((cells) => el('tr', null, ...left('td', cells))));
const figure = (value) => !isNumber(value) ? '–'
  : value !== 0 && Math.abs(value) < 0.01 ? value.toExponential(2) : String(Number(value.toPrecision(4)));

// ---- Plots

const LEAST = 1e-3;  // px: smaller errors lie on the axis

/** A curve for each of `series`, {name, style, dashed, where, y}: `y` of the rows that fit, over their `x`. */
function curves({ table, where, x, y, series, bottom, logX, ...more }) {
  const joined = uPlot.join(series.map((s) => {
    const fit = rows(table, { ...where, ...s.where }).filter((row) => !logX || row[x] > 0).sort((a, b) => a[x] - b[x]);
    return [fit.map((row) => row[x]), fit.map((row) => row[s.y || y])];
  }));
  return plot({ ...more, logX, logY: Boolean(bottom), bottom, x: joined[0],
    series: series.map((s, i) => ({ ...s, values: joined[i + 1] })) });
}
const by = (column, keys) => keys.map(([key, name, style]) => ({ name, style, where: { [column]: key } }));
const ROTATIONS = by('rotation', [['as_printed', 'as printed', 's4'], ['first_order', 'first order', 's2'],
  ['homography', 'homography', 's1']]);
const DEPTHS = by('depth', [['reference', 'reference depth', 's4'], ['learnt', 'learnt V', 's2'], ['truth', 'true depth', 's1']]);
const AXES = by('axis', [['pan', 'pan', 's1'], ['tilt', 'tilt', 's2'], ['roll', 'roll', 's3']]);
/** A measured curve, and beside it the one that theory expects. */
const besideTheory = (y, name, style, where) => [{ name, style, where, y },
  { name: 'expected', style, where, y: 'expected_' + y, dashed: true }];

const section = (title, text, ...content) => el('section', null, el('h2', null, title), el('p', { class: 'quiet' }, text), ...content);
const plotSection = (title, text, common, plots) => section(title, text,
  el('div', { class: 'plots' }, ...plots.map((each) => curves({ ...common, ...each }))));

const rendered = { points: 'rendered' }, step_m = Math.max(...values('rotation', 'step_m'));
const imus = values('imu', 'imu').filter((name) => name !== 'ideal');
const imuCurves = (y) => imus.flatMap((imu, i) => besideTheory(y, imu, 's' + (i % 5 + 1), { imu }));
const ownDrift = (y, unit) => ({ title: y.replace(/_.*/, '') + ', ' + unit,
  series: besideTheory(y, 'IMU alone', 's4', { odometry: 'no' }).concat(besideTheory(y, 'with odometry', 's1', { odometry: 'yes' })) });
const way = (name, style, rotation, told_by) => ({ name, style, where: { rotation, told_by } });
const limit = (model, dashed) => AXES.map(({ name, style }) => ({ name: dashed ? 'expected' : name, style, dashed,
  y: model + '_limit_' + name + '_deg' }));

// ---- The page

document.getElementById('head').append(el('h1', null, 'When does the kinematics model hold?'),
  el('p', { class: 'quiet' }, data.subject), el('p', null, el('b', null, data.bottom_line)));
document.getElementById('page').append(
  section('The answer', 'Is each part of the model within ' + data.tolerance_px + ' px?',
    leftTable(['', '', ''], data.statements.map((s) => [s.topic, s.text, el('span', null, el('span',
      { class: 'badge ' + ({ yes: 'met', no: 'unmet' }[s.verdict.split(':')[0]] || 'new') }, s.verdict.split(':')[0]), s.verdict.replace(/^\w+:/, ''))])),
    el('details', null, el('summary', null, 'Each figure beside the one that theory expects'),
      leftTable(['figure', 'measured', 'expected', 'unit'], tables.answer.map((f) => [f.figure, figure(f.value), figure(f.expected), f.unit])))),
  section('Rendered drives', 'The filter’s own landmarks compared with the simulator’s truth: end-point error, px, median and (95 in 100).',
    leftTable(['drive', 'motion told by', 'rotation', ...DEPTHS.map((d) => d.name)], rows('drives', DEPTHS[0].where).map((row) =>
      [row.drive, row.told_by, row.rotation.replace('_', ' '), ...DEPTHS.map((d) => {
        const [{ median_px, p95_px }] = rows('drives', { drive: row.drive, told_by: row.told_by, rotation: row.rotation, ...d.where });
        return digits(median_px) + ' (' + digits(p95_px) + ')';
      })]))),
  plotSection('Turning', 'End-point error, px, that 95 in 100 rendered corners stay within, over the turn in a frame. Errors below '
    + LEAST + ' lie on the axis.', { table: 'rotation', x: 'angle_deg', xName: 'deg', y: 'p95_px', bottom: LEAST },
    [0, step_m].flatMap((step) => AXES.map((axis) => ({ title: axis.name + (step ? ', driving too' : ', turning only'), series: ROTATIONS,
      where: { ...rendered, ...axis.where, step_m: step, depth: 'truth' } })))),
  plotSection('Driving', 'Median end-point error, px, of rendered corners: over the step in a frame as a share of the depth; then, at the '
    + 'nominal speed and a pan of 1 deg, over the distance from the focus of expansion. A step that brings points to the reference depth of '
    + data.reference_depth_m + ' m makes it right by chance.', { where: rendered, y: 'median_px', bottom: LEAST },
    [{ title: 'by the depth', table: 'translation', x: 'step_over_depth', xName: 'speed / (rate x depth)', logX: true, series: DEPTHS },
      { title: 'homography', table: 'foe_distance', x: 'from_px', xName: 'px from the FOE', series: DEPTHS,
        where: { ...rendered, rotation: 'homography' } },
      { title: 'true depth', table: 'foe_distance', x: 'from_px', xName: 'px from the FOE', series: ROTATIONS,
        where: { ...rendered, depth: 'truth' } }]),
  plotSection('Focal length', 'The largest turn in a frame, deg, with an error of first order within ' + data.tolerance_px
    + ' px at all geometric points; and the median error of V, px, of rendered corners at the nominal speed.',
    { table: 'focal_length', x: 'focal_px', xName: 'px of focal length', logX: true },
    [{ title: 'largest turn', where: { points: 'geometric' }, series: limit('first_order').concat(limit('theory', true)) },
      { title: 'V', where: rendered, bottom: 1e-2, series: [{ name: 'reference depth', style: 's4', y: 'reference_median_px' },
        { name: 'learnt V', style: 's2', y: 'learnt_median_px' }] }]),
  plotSection('Mount', 'Root mean square error, px, of the homography with the true depth, where the camera is mounted otherwise than the filter was told.',
    { table: 'mount', x: 'error_deg', xName: 'deg off', y: 'rms_px', series: AXES }, values('mount', 'pan_deg').map((pan_deg) =>
      ({ title: pan_deg ? 'panning by ' + pan_deg + ' deg a frame' : 'straight on', where: { ...rendered, pan_deg } }))),
  plotSection('IMU', 'Root mean square error, px, of the homography with the true depth, on a straight drive from a known start; dashed: expected by theory.',
    { table: 'imu', x: 'rate_hz', xName: 'frames/s', logX: true, bottom: 1e-2 },
    [{ title: 'IMU alone', where: { odometry: 'no' }, series: imuCurves('rms_px') },
      { title: 'with odometry', where: { odometry: 'yes' }, series: imuCurves('rms_px') },
      { title: 'rotation alone', where: { odometry: 'no' }, series: imuCurves('rotation_rms_px') }]),
  plotSection('Bumps', 'On wheels over rough ground: the turn of the camera in a frame, deg, and the root mean square error, px, of each way to take the rotation out.',
    { table: 'bumps', x: 'roughness_m', xName: 'm of roughness' },
    [{ title: 'turn in a frame, deg', where: { rotation: 'none' }, series: [{ name: 'median', style: 's1', y: 'turn_median_deg' },
      { name: '95 in 100', style: 's2', y: 'turn_p95_deg' }, { name: 'largest', style: 's4', y: 'turn_max_deg' }] },
    { title: 'error, px', y: 'rms_px', bottom: LEAST, series: [way('left in', 's5', 'none', 'truth'), way('as printed', 's4', 'as_printed', 'truth'),
      way('first order', 's2', 'first_order', 'truth'), way('homography', 's1', 'homography', 'truth'),
      way('homography, told by the IMU', 's3', 'homography', 'imu')] }]),
  plotSection('Drift of ' + tables.drift[0].imu, 'Root mean square error of velocity and attitude over time from a known start, straight on; dashed: expected by theory. '
    + 'The other IMUs are in drift.csv.', { table: 'drift', where: { imu: tables.drift[0].imu }, x: 't_s', xName: 's', bottom: 1e-4 },
    [ownDrift('forward_mps', 'm/s'), ownDrift('lateral_mps', 'm/s'), ownDrift('vertical_mps', 'm/s'), ownDrift('tilt_rad', 'rad'),
      ownDrift('heading_rad', 'rad')]));
})();
