// Lays out the data of a suite with the helpers of plot.js.
(() => {
'use strict';

const hasBaseline = data.baseline !== null;

// ---- Numbers

/** A change or spread with the decimals of its figure `of`; '' if it rounds to 0. */
function digitsBeside(value, of) {
  const text = Math.abs(value).toFixed((digits(of).split('.')[1] || '').length);
  return Number(text) === 0 ? '' : text;
}
function changeText(change, of) {
  if (change === 0) return '=';
  const text = digitsBeside(change, of);
  return text === '' ? '≈' : (change > 0 ? '+' : '−') + text;
}

const COLOURS = { improved: 'good', regressed: 'bad' };

function figureCell(figure) {
  if (!figure) return el('td', { class: 'nothing' }, '–');
  const cell = el('td', null, digits(figure.mean));
  if (isNumber(figure.spread)) {
    cell.append(el('span', { class: 'spread', title: 'half of the distance between the least and the greatest of the seeds' },
      '±' + (digitsBeside(figure.spread, figure.mean) || '0')));
  }
  if (hasBaseline) {
    const { before, change, half, verdict } = figure;
    const noise = !isNumber(half) ? ', noise unknown'
      : ', ' + Number((100 * (1 - data.baseline.level)).toPrecision(3)) + ' % interval ±' + Number(half.toPrecision(2));
    cell.append(el('span', { class: 'change ' + (COLOURS[verdict] || ''),
      title: isNumber(before) ? 'was ' + Number(before.toPrecision(6)) + noise +
        ', over the scenarios and seeds that both have' : 'not compared' },
      isNumber(change) ? changeText(change, figure.mean) : ''));
  }
  return cell;
}

const STANDINGS = { passed: '✓ passed', failed: '✗ failed', error: '! error', regressed: '▼ regressed', changed: '? changed', improved: '▲ improved' };
const badges = (standings) => standings.flatMap((standing) => [el('span', { class: 'badge ' + standing }, STANDINGS[standing]), ' ']);

// ---- The head

const F1 = data.metrics['rebel.f1'].label;

/** Columns in which at least one scenario has a figure; recordings have no times. */
const SHOWN_COLUMNS = data.columns.filter((name) => data.scenarios.some((scenario) => scenario.figures[name]));

/** F1, or of a scenario in which nothing is to be found the false corners. */
function mainFigure(scenario) {
  const f1 = scenario.figures['rebel.f1'], false_ = scenario.figures['rebel.false_corners_per_frame'];
  return f1 ? F1 + ' ' + digits(f1.mean) : false_ ? digits(false_.mean) + ' false corners a frame' : '';
}

/** The verdict, and below it the suite or run. */
function head() {
  const runs = data.scenarios.flatMap((s) => s.runs);
  const what = data.is_run ? data.scenarios[0].name + ' by ' + data.detector + ', seed ' + runs[0].seed
    : 'Suite by ' + data.detector + ', ' + data.run_counts;
  document.getElementById('head').append(
    el('h1', { class: { green: 'good', yellow: 'doubt', red: 'bad' }[data.light] }, (data.is_run ? mainFigure(data.scenarios[0]) + ', ' : '') + data.verdict),
    el('p', { class: 'quiet' }, what + (hasBaseline ? ', against ' + data.baseline.folder : '') +
      (data.sets.length ? ', with ' + data.sets.join(', ') : ''), data.note ? [el('br'), data.note] : null));
}

function foot() {
  const fact = (name, value) => value === '' ? null : el('span', null, name + ' ', el('b', null, value));
  return el('footer', { class: 'facts' }, fact('version', data.version), fact('settings', data.sets.join(', ')),
    fact('frames of', data.recorded), fact('baseline', hasBaseline
      ? [data.baseline.detector, data.baseline.version, ...data.baseline.sets].join(', ') : ''));
}

// ---- What is worst

const SHOWN = 8;

function remarkOf(remark) {
  const scenario = data.scenarios.find((s) => s.name === remark.scenario);
  return el('article', { class: 'remark' }, ...badges(remark.standings), data.is_run ? null : link(scenario),
    el('ul', null, ...remark.reasons.map((reason) => el('li', null, reason))));
}

function worst() {
  const isGood = (remark) => remark.standings.every((standing) => ['passed', 'improved'].includes(standing));
  const bad = data.remarks.filter((r) => !isGood(r)).map(remarkOf);
  const good = data.remarks.filter(isGood).map(remarkOf);
  const side = (content) => el('div', { class: 'side' }, ...content);
  const folded = (title, content) => content.length === 0 ? null
    : el('details', null, el('summary', null, title), side(content));
  return el('section', { id: 'worst' }, bad.length ? el('h2', null, 'Worst first') : null, side(bad.slice(0, SHOWN)),
    folded((bad.length - SHOWN) + ' more', bad.slice(SHOWN)),
    data.more_remarks > 0 ? el('p', { class: 'quiet small' }, 'and ' + data.more_remarks + ' scenarios less bad, in the table') : null, folded(good.length + ' improved', good),
    folded('Not compared', data.not_compared.map((what) => el('p', { class: 'small' }, what))));
}

/** A table of figures, whose headings call `sorting` if it is given. */
function figureTable(id, first, rows, sorting) {
  return table({ id }, [null, ...SHOWN_COLUMNS].map((name) => {
    const { label, title } = data.metrics[name] || { label: first, title: null };
    return el('th', { scope: 'col', title, 'data-metric': name },
      sorting ? el('button', { type: 'button', onclick: (e) => sorting(e.currentTarget.parentNode) }, label) : label);
  }), rows);
}
const figureRow = (attributes, first, figures) => el('tr', attributes, el('td', null, first),
  ...SHOWN_COLUMNS.map((name) => figureCell(figures[name])));

function groupTable() {
  if (data.groups.length === 0) return null;
  return el('section', null,
    el('h2', null, 'Means of the groups'),
    el('p', { class: 'quiet small' }, 'Over so many scenarios; precision, recall and F1 over those with F1, in which something moves.'),
    figureTable('groups', 'Group', data.groups.map((g) => figureRow(null, g.label, g.figures))));
}

// ---- The table of scenarios

/** The anchor of a scenario, of its run with a seed, and of an event in that: by names, so that links outlive other results. */
const anchor = (scenario, run, event) => scenario.name + (run ? '/seed-' + run.seed : '') + (event ? '/' + event.id : '');
const address = (path) => path.split('/').map(encodeURIComponent).join('/');

/** A link that opens and shows the section, run or event. */
const linkTo = (id, text, title) => el('a', { href: '#' + address(id), title, onclick: () => openAt(id) }, text);
const link = (scenario) => linkTo(anchor(scenario), scenario.name, scenario.purpose);

function openAt(id) {
  const scenario = data.scenarios.find((s) => id === s.name || id.startsWith(s.name + '/seed-'));
  if (!scenario) return;
  const section = document.getElementById(scenario.name);
  if (section) {
    section.open = true;
    section.fill();
  }
  const run = scenario.runs.find((r) => (id + '/').startsWith(anchor(scenario, r) + '/'));
  if (run && section) section.show(run);
  (document.getElementById(id) || section)?.scrollIntoView();
}

function scenarioRow(scenario) {
  const marks = scenario.standings.join() === 'passed' ? null
    : el('span', null, ' ', ...badges(scenario.standings));
  return Object.assign(figureRow({ 'data-scenario': scenario.name }, [link(scenario), marks],
    scenario.figures), { scenario });
}

function scenarioTable() {
  const rows = data.scenarios.map(scenarioRow);
  let byChange = false, sorted = null, descending = false;

  const keyOf = ({ scenario }, name) => name
    ? scenario.figures[name]?.[byChange ? 'change' : 'mean'] ?? null : scenario.name;
  const sort = () => {
    const name = sorted.dataset.metric || null;
    rows.sort((a, b) => {
      const x = keyOf(a, name), y = keyOf(b, name);
      if (x === null || y === null) return (x === null) - (y === null);  // undefined ones come last
      const order = name ? x - y : x.localeCompare(y, 'en', { numeric: true });
      return descending ? -order : order;
    });
    all.querySelector('tbody').append(...rows);
    for (const other of sorted.parentNode.children) other.removeAttribute('aria-sort');
    sorted.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
  };
  const onSort = (heading) => {
    descending = sorted === heading ? !descending : false;
    sorted = heading;
    sort();
  };
  const all = figureTable('scenarios', 'Scenario', rows, onSort);

  const shown = el('span', { class: 'quiet small', role: 'status' });
  const filter = el('input', { type: 'search', id: 'filter', 'aria-label': 'Filter the scenarios',
    placeholder: 'Filter: name, group, purpose, failed …', oninput: () => {
      const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
      let count = 0;
      for (const row of rows) {
        const s = row.scenario;
        const text = [s.name, s.purpose, ...s.standings, ...s.groups].join(' ').toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
        document.getElementById(anchor(s)).hidden = row.hidden;
        count += !row.hidden;
      }
      shown.textContent = words.length ? count + ' of ' + rows.length : '';
    } });
  const change = el('button', { type: 'button', id: 'by-change', 'aria-pressed': 'false', onclick: () => {
    byChange = !byChange;
    change.setAttribute('aria-pressed', String(byChange));
    if (sorted) sort();
  } }, 'sort by change');

  return el('section', null,
    el('h2', null, 'Scenarios'),
    el('div', { class: 'controls' }, filter, hasBaseline ? change : null, shown),
    el('p', { class: 'quiet small' }, 'Means over the seeds',
      hasBaseline ? '; below them the change against the baseline, coloured where it is real (lcs compare has the same rule).' : '.'),
    all);
}

// ---- Plots

/** Number of corners in the last five frames: the store that the layers replace. */
function fiveFrameStore(corners) {
  return corners.map((_, i) => corners.slice(Math.max(0, i - 4), i + 1).reduce((sum, n) => sum + (n || 0), 0));
}

let plotted = 0;

function framePlots(run, onPoint) {
  const f = run.frames;
  // Every row has a time, and an event's frame is the index of a row.
  const time = (frame) => f.t_s[Math.min(Math.max(frame, 0), f.t_s.length - 1)];
  const bands = (run.events || []).filter((event) => event.family !== 'squares').map((event) => ({ from: time(event.first_frame), to: time(event.last_frame),
    kind: event.of > 0 ? 'miss' : 'false' }));
  const common = { x: f.t_s, xName: 's', sync: 'run' + ++plotted, onPoint };
  const was = run.before && run.before.frames;
  /** The series of a column, and of the baseline's. */
  const both = (name, style, column) => [{ name, values: f[column], style },
    ...(was ? [{ name: 'before', values: f.t_s.map((_, i) => was[column][i]), style, faint: true }] : [])];
  return el('div', { class: 'plots' },
    plot({ ...common, title: 'Precision and recall', top: 1.05, bands, series: [
      ...both('precision', 's1', 'precision'), ...both('recall', 's2', 'recall')] }),
    plot({ ...common, title: 'Edges', series: [
      ...both('normal', 's1', 'normal_edges'), ...both('rebel', 's4', 'rebel_edges')] }),
    plot({ ...common, title: 'Circles and squares', series: [...both('normal circles', 's3', 'normal_circles'),
      ...both('rebel circles', 's2', 'rebel_circles'), ...both('squares', 's5', 'squares')] }),
    plot({ ...common, title: 'Dimensionality', series: [
      ...both('all layers', 's1', 'dimension'), { name: 'corners', values: f.corners, style: 's3' },
      { name: 'store of five frames', values: fiveFrameStore(f.corners), style: 's2', dashed: true }] }));
}

/** The plots and the run's video, if it has one. Pointing at a plot shows that frame. */
function overTime(run) {
  if (!run.frames || run.frames.t_s.length === 0) return el('p', { class: 'nothing' }, 'The run left no frames.csv.');
  if (data.video_left_out_mb) {
    return el('div', null, el('p', { class: 'nothing' }, 'The video has ' + data.video_left_out_mb
      + ' MB, too much for a page: it is in video.mp4 beside it.'), framePlots(run));
  }
  if (!data.video) return framePlots(run);
  const times = run.frames.t_s, last = times.length - 1;
  const readout = el('div', { class: 'readout' }, 'Point at a plot to see its frame; ← and → go to the next.');
  const video = el('video', { src: 'data:video/mp4;base64,' + data.video, controls: '', muted: '',
    onerror: () => readout.replaceChildren('This browser cannot show the video; it is in video.mp4.'),
    onplay: () => follow(), onseeked: () => follow(), onkeydown: (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      video.pause();
      show(frame() + step);
    } });
  const frame = () => Math.min(last, Math.floor(video.currentTime / video.duration * times.length));
  const show = (wanted) => {
    if (!video.duration || wanted === frame()) return;
    video.currentTime = (Math.min(last, Math.max(0, wanted)) + 0.5) * video.duration / times.length;
  };
  let pointing = false;
  const plots = framePlots(run, (pointed) => { if (video.paused && pointing) show(pointed); });
  plots.addEventListener('mouseenter', () => { pointing = true; });
  plots.addEventListener('mouseleave', () => { pointing = false; });
  const follow = () => {
    readout.textContent = 'frame ' + frame() + ' · ' + times[frame()].toFixed(2) + ' s';
    if (!pointing) for (const figure of plots.children) figure.pointAt(times[frame()]);
    if (!video.paused) requestAnimationFrame(follow);
  };
  return el('div', { class: 'scrub' }, el('div', null, video, readout), plots);
}

// ---- Events

function headline(event) {
  const frames = event.first_frame === event.last_frame ? 'frame ' + event.first_frame : 'frames ' + event.first_frame + ' to ' + event.last_frame;
  const cost = event.family === 'squares' ? event.frames + (event.of_frames ? ' of ' + event.of_frames : '') + ' frames'
    : event.of > 0 ? event.corners + ' of ' + event.of + ' corners missed' + (event.radial ? ', ' + event.radial + ' of them radial' : '')
    : (event.circles ? event.circles + ' circle' + (event.circles > 1 ? 's' : '') + (event.corners ? ' with ' : '') : '')
      + (event.corners || !event.circles ? event.corners + ' false corners' : '');
  return (event.object_name ? event.object_name + ': ' : '') + event.meaning + ', ' + frames + ': ' + cost;
}

function reasonBars(event) {
  return el('div', { class: 'reasons' }, ...event.reasons.map((reason) => {
    const share = reason.corners / event.corners;
    return el('div', { class: 'reason', title: reason.word + ': ' + reason.corners + ' corners' },
      el('span', { class: 'share' }, share < 0.005 ? '< 1 %' : Math.round(100 * share) + ' %'),
      el('span', { class: 'bar', style: '--share:' + (100 * share).toFixed(1) + '%' },
        el('span', null, reason.meaning)));
  }));
}

const ink = (moves) => 'var(--' + (moves ? 's4' : 's1') + ')';

/** The surroundings of a corner on an enlarged picture: a line to each neighbour, as wide as its weight and as strong as its belief,
 * red if it says that the corner moves; a cross at each prediction, of a static point blue, of a moving one red. */
function surroundings(corner, view) {
  const cross = (at, moves) => at && el('g', null, ...[['white', 0.9], [ink(moves), 0.4]].map(([stroke, width]) =>
    el('path', { d: `M${at[0] - 1},${at[1] - 1}l2,2m0,-2l-2,2`, stroke, 'stroke-width': width })));
  return el('svg', { viewBox: `${corner.x - 32} ${corner.y - 24} 64 48`, role: 'img', 'aria-label': 'its neighbours and predictions' },
    el('image', { href: picture(view), x: view.x - view.half_width, y: view.y - view.half_height, width: 2 * view.half_width, height: 2 * view.half_height }),
    ...(corner.neighbours || []).map(([x, y, weight, belief]) => el('line', { x1: corner.x, y1: corner.y, x2: x, y2: y,
      stroke: ink(belief > 0), 'stroke-width': 0.3 + weight, 'stroke-opacity': 0.1 + 0.9 * Math.abs(belief) })),
    cross(corner.static, false), cross(corner.moving, true));
}

/** The history of a corner: L (dots) and m (rings) from -12 to 12, and the misses of the static (blue) and the moving prediction (red). */
function historyPlot(corner) {
  const first = corner.history[0][0], frames = Math.max(1, corner.history.at(-1)[0] - first);
  const dot = (frame, value, colour, hollow) => isNumber(value) && el('path', { stroke: colour, fill: hollow ? 'none' : colour,
    d: `M${4 + 152 * (frame - first) / frames - 1},${20 - 1.5 * Math.max(-12, Math.min(12, value))}a1,1 0 1,0 2,0a1,1 0 1,0 -2,0`, 'stroke-width': 0.5 });
  return el('figure', null, el('svg', { viewBox: '0 0 160 40', role: 'img', 'aria-label': 'its history; the table has the numbers' },
    el('line', { x1: 0, y1: 20, x2: 160, y2: 20, stroke: 'var(--quiet)', 'stroke-width': 0.3 }),
    ...corner.history.flatMap(([frame, still, moving, L, m]) => [dot(frame, still, ink(false)), dot(frame, moving, ink(true)),
      dot(frame, L, 'var(--quiet)'), dot(frame, m, 'var(--text)', true)].filter(Boolean))),
    el('figcaption', null, `frames ${first} to ${first + frames}, -12 to 12: L grey, m rings; misses in px, static blue, moving red`));
}

/** The sightings of a corner, as `lcs explain` prints them. */
function historyText(corner) {
  const cells = (row) => row.map((cell, i) => cell === null ? '-' : isNumber(cell) && i > 0 ? cell.toFixed(2) : String(cell));
  return [['frame', 'miss static', 'miss moving', 'L', 'm', 'verdict'], ...corner.history].map(cells)
    .map((row) => [5, 11, 11, 6, 6, 0].map((width, i) => row[i].padStart(width)).join('  ') + '\n').join('');
}

/** The command that explains a corner; a run that kept no frames is made again for it. */
function explainCommand(run, frame, x, y) {
  const folder = !run.has_frames ? 'out/explained' : data.is_run ? '.' : run.folder;
  const made = run.has_frames ? '' : `${run.command} --no-video --out ${folder} && `;
  return commandLine(`${made}lcs explain ${folder} ${frame} ${x} ${y}`);
}

/** The explanation of the corner at a click on a picture, and the command for it in the folder of the page. */
function explainAt(run, view, click) {
  const scale = 2 * view.half_width / click.target.clientWidth;
  const x = view.x + scale * click.offsetX - view.half_width, y = view.y + scale * click.offsetY - view.half_height;
  const off = (corner) => Math.hypot(corner.x - x, corner.y - y);
  const near = ((data.explained || {})[view.frame] || []).filter((corner) => off(corner) < Math.max(3, 8 * scale));
  const corner = near.sort((a, b) => off(a) - off(b))[0];
  const at = corner || { x: x.toFixed(1), y: y.toFixed(1) };
  const command = explainCommand(run, view.frame, at.x, at.y);
  return corner ? el('div', { class: 'explained' }, corner.history ? el('div', null, surroundings(corner, view), historyPlot(corner)) : null,
    el('pre', null, corner.text + (corner.history ? historyText(corner) : '')), command) : command;
}

const picture = (view) => 'data:image/jpeg;base64,' + view.jpeg_base64;

function strip(event, run) {
  const command = el('div');
  const pictures = event.views.filter((view) => view.jpeg_base64 !== '');
  if (pictures.length === 0) {
    return event.left_out ? el('p', { class: 'nothing small' }, 'Pictures are left out to keep the page small; the command above shows them with --report.') : null;
  }
  return el('div', null, el('div', { class: 'strip' }, ...pictures.map((view) => el('figure', null,
    el('img', { title: 'A click on a corner explains it',
      onclick: (click) => command.replaceChildren(explainAt(run, view, click)), src: picture(view), width: 256, height: 192,
      alt: 'frame ' + view.frame + ' around: ' + headline(event) }),
    el('figcaption', null, 'frame ' + view.frame + ' · ' + view.t_s.toFixed(2) + ' s')))), command);
}

const FAMILIES = {
  rebels: ['Rebels', null],
  circles: ['Circles with no mover under them', 'Rebel circles, in violet; the rules shown belong to the false corners in them.'],
  squares: ['Squares', 'White boxes are squares, with the outlines of their edges; thin ones objects, the orange one is the object that is meant.'],
};

/** Names each event of a run by its kind, object and first frame; alike ones are numbered. */
function nameEvents(run) {
  const times = new Map();
  for (const event of run.events || []) {
    const name = [event.kind, event.object_name, event.first_frame].filter((part) => part !== '').join('-');
    times.set(name, (times.get(name) || 0) + 1);
    event.id = name + (times.get(name) > 1 ? '-' + times.get(name) : '');
  }
}

function eventList(scenario, run) {
  if (!run.events) return el('p', { class: 'nothing' }, 'The run left no events.json.');
  const gone = run.before && run.before.gone.length > 0 ? el('div', null, el('h4', null, 'Gone: among the worst of the baseline, no longer here'),
    el('ul', null, ...run.before.gone.map((event) => el('li', null, headline(event))))) : null;
  if (run.events.length === 0) return gone || el('p', { class: 'nothing' }, 'No misses and no false alarms to speak of.');
  const mark = (style, sign, text) => el('span', null, el('i', { class: style, 'aria-hidden': 'true' }, sign), text);
  return el('div', null,
    el('div', { class: 'marks' }, mark('m1', '○', 'missed (orange ring)'), mark('m2', '●', 'found (green dot)'),
      mark('m3', '×', 'false (violet cross)'), mark('m4', '□', 'where a mover really is (thin box)'),
      mark('m4', '◇', 'radial: its image moves as the image of a static point may (diamond)')),
    ...Object.entries(FAMILIES).map(([family, [title, note]]) => {
      const events = run.events.filter((event) => event.family === family);
      return events.length === 0 ? null : el('section', null, el('h4', null, title),
        note && el('p', { class: 'small quiet' }, note), ...events.map((event) => el('article', { class: 'event', id: anchor(scenario, run, event) },
          el('h5', null, event.is_new ? el('span', { class: 'badge new', title: 'not among the worst of the baseline' }, 'new') : null,
            (event.is_new ? ' ' : '') + headline(event) + ' ', linkTo(anchor(scenario, run, event), '#', 'link to this event')),
          strip(event, run), reasonBars(event))));
    }), gone);
}

// ---- A scenario

const seedText = (run) => 'seed ' + run.seed;
const bound = (c) => [isNumber(c.min) ? '≥ ' + tickText(c.min) : '', isNumber(c.max) ? '≤ ' + tickText(c.max) : '']
  .filter(Boolean).join(', ');

function criteriaTable(scenario) {
  const with_ = scenario.runs.filter((run) => run.criteria.length > 0);
  if (with_.length === 0) return el('p', { class: 'nothing' }, 'It asks for nothing.');
  return table({ class: 'criteria' }, ['Figure', 'must be', ...with_.map(seedText)],
    with_[0].criteria.map((c, i) => el('tr', null,
      el('td', null, el('code', null, c.metric), c.required ? null : el('span', { class: 'quiet small' }, ' not required')),
      el('td', null, bound(c), c.over === 'seed' ? null : el('span', { class: 'quiet small' }, ' over seeds: ' + c.over)),
      ...with_.map((run) => el('td', null, el('span', { class: 'badge ' + (run.criteria[i].met ? 'met' : 'unmet') },
        (run.criteria[i].met ? '✓ ' : '✗ ') + digits(run.criteria[i].value)))))));
}

function allFigures(scenario) {
  const names = Object.keys(scenario.figures);
  if (names.length === 0) return null;
  return el('details', null, el('summary', null, 'All figures'),
    table(null, ['Figure', 'mean', ...scenario.runs.map(seedText)],
      names.map((name) => el('tr', null,
        el('td', { title: data.metrics[name].title }, el('code', null, name)),
        figureCell(scenario.figures[name]),
        ...scenario.runs.map((run) => el('td', null, digits(run.metrics[name])))))));
}

function commandLine(command) {
  return el('div', { class: 'command' }, el('code', null, command),
    el('button', { type: 'button', onclick: (event) => {
      const button = event.currentTarget;
      navigator.clipboard.writeText(command).then(() => { button.textContent = 'copied'; },
        () => { button.textContent = 'select it'; });
    } }, 'copy'));
}

function runBody(scenario, run) {
  nameEvents(run);
  return el('div', { id: anchor(scenario, run) },
    el('p', { class: 'quiet small' }, 'To run it again:'), commandLine(run.command),
    run.error ? el('p', { class: 'message' }, run.error) : null,
    ...run.warnings.map((warning) => el('p', { class: 'message' }, 'warning: ' + warning)),
    run.before && run.before.error ? el('p', { class: 'message' }, 'baseline: ' + run.before.error) : null,
    run.folder && !data.is_run ? el('p', { class: 'quiet small' }, 'Its files: ', el('a', { href: address(run.folder) + '/' }, run.folder)) : null,
    run.outcome === 'error' || !scenario.is_whole ? null : [el('h3', null, 'Over time'), overTime(run),
      el('h3', null, 'Misses and false alarms'), notes(run), eventList(scenario, run)]);
}

/** Names the share of F1 that is lost on radial corners, if it is large, and how movers can be found by few corners. */
function notes(run) {
  const lost = run.metrics['rebel.f1_lost_radial'];
  const radial = lost > 0.1 ? 'F1 lost on radial corners: ' + digits(lost)
    + '. They lie on a mover along the line of sight, whose image moves as the image of a static point may. ' : '';
  const few = run.metrics['rebel.object_recall'] - run.metrics['rebel.recall'] > 0.5
    ? 'A mover is found by 3 of its corners in one frame; recall counts all of its corners in all frames.' : '';
  return radial + few === '' ? null : el('p', { class: 'small' }, radial + few);
}

/** \return the element, with a function that shows a run. */
function scenarioBody(scenario) {
  const place = el('div');
  const buttons = scenario.runs.map((run) => el('button', { type: 'button', onclick: () => show(run) },
    seedText(run) + (run.outcome === 'passed' ? '' : ' ' + STANDINGS[run.outcome])));
  const show = (run) => {
    buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(scenario.runs[i] === run)));
    place.replaceChildren(runBody(scenario, run));
  };
  if (scenario.runs.length > 0) show(scenario.runs[0]);
  return Object.assign(el('div', { class: 'body' },
    el('div', { class: 'facts small' }, el('span', null, 'file ', el('code', null, scenario.file)),
      el('span', null, 'groups ' + scenario.groups.join(', ')),
      ...scenario.point.map(([key, value]) => el('span', null, key + ' ', el('b', null, value)))),
    scenario.is_whole ? null : el('p', { class: 'nothing' }, 'Not among the worst: curves and events are left out. Its files have them.'),
    el('h3', null, 'Criteria'), criteriaTable(scenario), scenario.is_whole ? allFigures(scenario) : null,
    data.is_run ? null : el('div', { class: 'tabs', role: 'group', 'aria-label': 'Seed' }, ...buttons), place), { show });
}

function scenarioSection(scenario) {
  let body = null;
  const fill = () => { if (!body) section.append(body = scenarioBody(scenario)); };
  const section = el('details', { class: 'scenario', id: anchor(scenario), ontoggle: () => { if (section.open) fill(); } }, el('summary', null, el('span', { class: 'name' }, scenario.name),
    el('span', { class: 'quiet' }, scenario.purpose),
    el('span', { class: 'right' }, mainFigure(scenario) + ' ', ...badges(scenario.standings))));
  return Object.assign(section, { fill, show: (run) => body.show(run) });
}

// ---- Sweeps

/** Scenarios of one file that sweep the same keys. */
function sweeps() {
  const all = {};
  for (const scenario of data.scenarios.filter((s) => s.point.length > 0)) {
    const key = JSON.stringify([scenario.file, scenario.point.map(([name]) => name)]);
    (all[key] ||= []).push(scenario);
  }
  return Object.values(all);
}

/** Swept values without the parts that are equal in all of them, such as a constant coordinate. */
function varying(values) {
  const lists = values.map((text) => (/^\s*\[(.*)\]\s*$/.exec(text) || [null, text])[1].split(',').map((part) => part.trim()));
  const places = lists[0].map((_, i) => i).filter((i) => lists.some((list) => list[i] !== lists[0][i]));
  return places.length === 1 && lists.every((list) => list.length === lists[0].length)
    ? lists.map((list) => list[places[0]]) : values;
}

/** Parses a number with its unit; null for any other text. */
function measure(text) {
  const found = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([^\s\d]\S*)?\s*$/i.exec(text);
  return found ? { value: Number(found[1]), unit: found[2] || '' } : null;
}

function sweepPlot(points) {
  const key = points[0].point[0][0];
  const measures = varying(points.map((s) => s.point[0][1])).map(measure);
  const numeric = measures.every((m) => m && m.unit === measures[0].unit);
  const sorted = points.map((scenario, i) => ({ scenario, x: numeric ? measures[i].value : i }))
    .sort((a, b) => a.x - b.x);
  const series = (name, style) => ({ name: data.metrics[name].label, style,
    values: sorted.map((p) => p.scenario.figures[name]?.mean),
    spread: sorted.map((p) => p.scenario.figures[name]?.spread || 0) });
  return el('div', { class: 'plots' }, plot({ title: 'Over ' + key, x: sorted.map((p) => p.x),
    xName: numeric ? measures[0].unit : 'point', top: 1.05, series: [
      series('rebel.f1', 's1'), series('rebel.recall', 's2')] }));
}

/** A cell's colour for a value from 0 (orange) to 1 (green); black text is readable on all. */
const heat = (value) => `hsl(${Math.round(28 + 110 * value)} 65% ${Math.round(84 - 22 * Math.abs(value - 0.5))}%)`;

function heatMap(points) {
  const [rowKey, columnKey] = points[0].point.map(([name]) => name);
  const valuesOf = (index) => {
    const all = [...new Set(points.map((s) => s.point[index][1]))];
    return all.every(measure) ? all.sort((a, b) => measure(a).value - measure(b).value) : all;
  };
  const columns = valuesOf(1);
  const heads = columns.map((value) => el('th', { scope: 'col' }, value));
  return table({ class: 'heat' }, [el('th'), ...heads],
    valuesOf(0).map((row) => el('tr', null, el('th', { scope: 'row' }, row),
      ...columns.map((column) => {
        const found = points.find((s) => s.point[0][1] === row && s.point[1][1] === column);
        const f1 = found?.figures['rebel.f1']?.mean;
        return el('td', { title: found?.name,
          style: isNumber(f1) ? 'background:' + heat(Math.min(1, Math.max(0, f1))) : 'color:inherit' }, digits(f1));
      }))), el('caption', { class: 'small' },
      F1 + ' over ' + rowKey + ' (down) and ' + columnKey + ' (across)'));
}

function sweepSection() {
  const all = sweeps();
  if (all.length === 0) return null;
  return el('section', { id: 'sweeps' }, el('h2', null, 'Sweeps'), ...all.map((points) => el('div', null,
    el('h3', null, points[0].file.replace(/^.*\//, '').replace(/\.yaml$/, '')),
    el('p', { class: 'quiet' }, points[0].purpose),
    points[0].point.length === 1 ? sweepPlot(points)
      : points[0].point.length === 2 ? heatMap(points)
        : el('p', { class: 'nothing' }, 'More than two keys are swept: see the table above.'))));
}

// ---- Beside other detectors

/** F1 of each scenario (up) over that of another detector (right): a dot above the diagonal is a lead. */
function scatter({ detector, f1 }) {
  const dots = data.scenarios.filter((s) => isNumber(f1[s.name]) && s.figures['rebel.f1']).map((s) => {
    const own = s.figures['rebel.f1'].mean, other = f1[s.name];
    return el('a', { href: '#' + address(anchor(s)), style: `left:${100 * other}%;bottom:${100 * own}%`,
      title: s.name + ': ' + digits(own) + ', ' + detector + ' ' + digits(other), onclick: () => openAt(anchor(s)) });
  });
  return el('figure', { class: 'scatter' }, el('div', null, ...dots), el('figcaption', { class: 'small' },
    F1 + ' of ' + data.detector + ' (up) over ' + detector + ' (right), each from 0 to 1'));
}

const besideSection = () => !data.beside?.length ? null : el('section', { id: 'beside' },
  el('h2', null, 'Beside other detectors'), el('div', { class: 'plots' }, ...data.beside.map(scatter)));

// ---- The page

head();
const first = data.scenarios[0];
document.getElementById('page').append(worst(), ...(data.is_run ? [
  figureTable('figures', '', [figureRow(null, null, first.figures)]), scenarioBody(first)] : [
  groupTable(), scenarioTable(), sweepSection(), besideSection(),
  el('section', null, el('h2', null, 'Each scenario'), ...data.scenarios.map(scenarioSection)),
]).filter(Boolean), foot());
// Opens the place that the page's address points to.
const openAddress = () => openAt(decodeURIComponent(location.hash.slice(1)));
addEventListener('hashchange', openAddress);
openAddress();
})();
