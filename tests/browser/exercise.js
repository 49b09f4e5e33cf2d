// Operates the page like a user, and writes the faults into an element for run.sh to read.
(async () => {
  const faults = window.faultsOnLoad;
  const expect = (what, is) => { if (!is) faults.push(what); };
  const until = async (is) => {
    for (let i = 0; i < 100 && !is(); ++i) await new Promise((done) => setTimeout(done, 20));
  };
  try {
    const data = JSON.parse(document.getElementById('data').textContent);
    expect('the verdict is the first line', document.body.innerText.trim().split('\n')[0].includes(data.verdict));
    expect('the versions are at the foot', document.querySelector('footer').textContent.includes(data.version));
    /** Whether something is drawn: looked at in a copy. */
    const isDrawn = (canvas) => {
      if (canvas.width === 0) return false;
      const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
      const context = copy.getContext('2d', { willReadFrequently: true });
      context.drawImage(canvas, 0, 0);
      return context.getImageData(0, 0, copy.width, copy.height).data.some((value) => value > 0);
    };
    const plotsAreDrawn = async (section, what) => {
      const canvases = [...section.querySelectorAll('figure.plot canvas')];
      expect(what + ' has four plots', canvases.length === 4);
      await until(() => canvases.every(isDrawn));
      expect(what + ' has drawn plots', canvases.every(isDrawn));
    };

    if (data.is_run) {
      expect('the figures are in a row', document.querySelectorAll('#figures tbody td').length > 8);
      await plotsAreDrawn(document, 'the run');
      const video = document.querySelector('video');
      await until(() => video.readyState > 0);
      expect('the video is there', video.duration > 0);
      // Pointing at the end of a plot shows the last frame.
      const plots = document.querySelector('.plots'), over = plots.querySelector('.u-over');
      const box = over.getBoundingClientRect();
      plots.dispatchEvent(new MouseEvent('mouseenter'));
      for (const type of ['mouseenter', 'mousemove']) {
        over.dispatchEvent(new MouseEvent(type, { clientX: box.right - 1, clientY: box.top + 5, bubbles: true }));
      }
      await until(() => video.currentTime > 0.8 * video.duration);
      expect('pointing shows the frame', video.currentTime > 0.8 * video.duration);
      // The plots follow the video's position.
      plots.dispatchEvent(new MouseEvent('mouseleave'));
      video.currentTime = 0.01;
      video.dispatchEvent(new Event('seeked'));  // the decoder ignores virtual time
      const first = () => [...plots.querySelectorAll('.u-legend tr:first-child .u-value')].map((cell) => cell.textContent);
      await until(() => first().every((text) => text === '0'));
      expect('the plots follow the video', first().every((text) => text === '0'));
      throw null;
    }
    /** The element that a link within the page points to. */
    const at = (link) => document.getElementById(decodeURIComponent(link.getAttribute('href').slice(1)));
    const table = document.getElementById('scenarios');
    const rows = () => [...table.tBodies[0].rows];
    const names = () => rows().map((row) => row.dataset.scenario);

    // The table has one row per scenario, with the scenario's figures.
    expect('a row a scenario', rows().length === data.scenarios.length && rows().length >= 2);

    // The worst results precede the tables and link to their sections.
    expect('regressions are told', data.baseline === null || data.remarks.some((r) => r.standings.includes('regressed')));
    for (const remark of document.querySelectorAll('#worst .remark')) {
      const link = remark.querySelector('a');
      link.click();
      expect(link.textContent + ' has reasons and a section', remark.querySelectorAll('li').length > 0 &&
        at(link).open);
    }

    // Headings sort, first upwards, then downwards; undefined figures stay last.
    const headings = [...table.tHead.rows[0].cells];
    for (const heading of headings) {
      const metric = heading.dataset.metric;
      const key = (row) => metric ? (row.scenario.figures[metric] || {}).mean : row.dataset.scenario;
      for (const direction of ['ascending', 'descending']) {
        heading.querySelector('button').click();
        expect(heading.textContent + ' says ' + direction, heading.getAttribute('aria-sort') === direction);
        const keys = rows().map(key);
        const defined = keys.filter((k) => k !== undefined && k !== null);
        expect('undefined figures of ' + heading.textContent + ' come last',
          defined.every((k, i) => k === keys[i]));
        const sorted = [...defined].sort((a, b) => metric ? a - b : a.localeCompare(b, 'en', { numeric: true }));
        if (direction === 'descending') sorted.reverse();
        expect(heading.textContent + ' sorts ' + direction, defined.every((k, i) => k === sorted[i]));
      }
    }

    // The filter keeps only matching rows.
    const filter = document.getElementById('filter');
    const look = (text) => {
      filter.value = text;
      filter.dispatchEvent(new Event('input'));
      return rows().filter((row) => row.offsetParent !== null).length;
    };
    expect('the filter finds one name', look(names()[0]) === 1);
    expect('the filter hides the other sections',
      [...document.querySelectorAll('details.scenario')].filter((d) => d.offsetParent !== null).length === 1);
    expect('the filter finds nothing', look('no such scenario') === 0);
    expect('the filter lets all back', look('') === rows().length);

    // Changes appear only with a baseline.
    const changes = [...document.querySelectorAll('#scenarios .change')].filter((c) => c.textContent !== '');
    expect('changes against the baseline', (changes.length > 0) === (data.baseline !== null));
    expect('changes are coloured', data.baseline === null || document.querySelector('.change.good, .change.bad'));
    expect('a button sorts by change', (document.getElementById('by-change') !== null) === (data.baseline !== null));

    // A name opens its section, which has plots, the command, and visible pictures.
    let pictures = 0;
    for (const row of rows()) {
      row.querySelector('a').click();
      const section = at(row.querySelector('a'));
      expect(row.dataset.scenario + ' opens', section.open);
      await until(() => section.querySelector('.body'));
      for (const [i, button] of section.querySelectorAll('.tabs button').entries()) {
        button.click();
        const families = new Set(row.scenario.runs[i].events.map((event) => event.family));
        expect(row.dataset.scenario + ' has its events by family',
          section.querySelectorAll('.body section').length === families.size);
        await plotsAreDrawn(section, row.dataset.scenario);
        expect(row.dataset.scenario + ' has the baseline beside', data.baseline === null ||
          [...section.querySelectorAll('.u-legend th')].some((label) => label.textContent === 'before'));
        expect(row.dataset.scenario + ' has no figure that is none', !/NaN|undefined/.test(section.innerHTML.replace(/(base64,|title=")[^"]*/g, '')));
        expect(row.dataset.scenario + ' has its command', section.querySelector('.command code').textContent.startsWith('lcs run '));
        for (const picture of section.querySelectorAll('.strip img')) {
          await until(() => picture.complete);
          expect('a picture shows', picture.naturalWidth === 256 && picture.naturalHeight === 192 && picture.alt !== '');
          ++pictures;
        }
      }
    }
    expect('there are pictures', pictures >= 3);

    // The address of an event, by names, shows it.
    const { name, runs } = data.scenarios[0], run = `${name}/seed-${runs.at(-1).seed}`;
    location.hash = '#' + run.split('/').map(encodeURIComponent).join('/');
    await until(() => document.getElementById(run));
    expect('an address shows its run', document.getElementById(run) !== null);
    const ids = [...document.getElementById(run).querySelectorAll('.event')].map((event) => event.id);
    expect('events have names', ids.length > 0 && new Set(ids).size === ids.length && ids.every((id) => id.startsWith(run + '/')));
    expect('false objects are events where there are some', data.scenarios.every((s) => s.runs.every((run) =>
      run.events.some((event) => event.family === 'circles') === run.metrics['rebel.false_objects_per_100_frames'] > 0)));
    expect('reasons are told', document.querySelectorAll('.reason').length > 0);
  } catch (error) {
    if (error) faults.push(String(error.stack || error));
  }
  const result = document.createElement('pre');
  result.id = 'exercise';
  result.textContent = faults.length === 0 ? 'EXERCISE-FINE' : 'EXERCISE-FAULTS ' + JSON.stringify(faults);
  document.body.append(result);
})();
