// The way from files to a report: one draft at a time, and runs of it.
const Api = (() => {
  const ask = async (address, options) => {
    const answer = await fetch(address, options).catch(() => { throw new Error('slideway serve does not answer; is it still running?'); });
    if (answer.ok) return answer;
    const text = await answer.text();
    let message = text;
    try { message = JSON.parse(text).error; } catch { /* no JSON */ }
    throw new Error(message);
  };
  const get = async (address) => (await ask(address)).json();
  const post = async (address, body = '') => (await ask(address, {method: 'POST', body, headers: {'Content-Type': 'application/octet-stream'}})).json();
  const save = (address) => ask(address).then(async (answer) => {
    const name = /filename="([^"]*)"/.exec(answer.headers.get('Content-Disposition') || '');
    const link = el('a', {href: URL.createObjectURL(await answer.blob()), download: name ? name[1] : true});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }).catch(Ui.fail);
  return {get, post, save};
})();

const Ui = {
  say: (text) => { $('status').textContent = text; },
  fail: (error) => { $('alert').textContent = error.message; $('alert').hidden = false; $('alert').scrollIntoView({block: 'nearest'}); },
  clear: () => { $('alert').hidden = true; },
  guard: (work) => async (...given) => { Ui.clear(); try { return await work(...given); } catch (error) { return Ui.fail(error); } },
};

(() => {
  const kMostFile = 64 * 2 ** 20;
  const kData = ['position-column', 'value-column', 'position-unit', 'value-unit'];
  const kLengths = ['m', 'mm', 'um', 'nm', 'inch'], kSlopes = ['rad', 'mrad', 'urad', 'arcsec', 'um_per_m', 'mm_per_m'];
  const kChoices = {
    'position-unit': [...kLengths, 's'].map((unit) => [unit, unit]), 'value-unit': [...kLengths, ...kSlopes].map((unit) => [unit, unit]),
    kind: [['face', 'a turned face'], ['slide', 'a reading along the slide']],
    trace: [['diameter', 'yes: a diameter'], ['radius', 'no: a radius']],
    direction: [['inward', 'inward'], ['outward', 'outward'], ['unknown', 'unknown']],
    free: [['offset,tilt', 'yes: both'], ['offset', 'its height only'], ['none', 'no: neither']],
    lever: [['split', 'split: the tool hangs on the carriage'], ['paper', 'paper: the arm reaches from the spindle axis']]};
  const draft = {id: '', opened: false, answers: new Map(), state: null, traces: [], edited: false, made: ''};
  let choices = {effects: [], tables: []}, runs = [], last = '', job = '';

  const path = (what) => `drafts/${draft.id}/${what}`;
  const steps = () => $('steps').replaceChildren(...[...document.querySelectorAll('main > section')].filter((section) => !section.hidden)
    .map((section) => el('li', {}, el('a', {href: '#' + section.id}, section.querySelector('h2').textContent))));
  const show = (id, isShown = true) => { $(id).hidden = !isShown; steps(); };

  // --- files ---------------------------------------------------------------------------------------
  const upload = Ui.guard(async (files) => {
    if (!files.length) return;
    for (const file of files) if (file.size > kMostFile) throw new Error(`${file.name} is larger than 64 MiB`);
    if (!draft.id) { reset(); draft.id = (await Api.post('drafts')).id; }
    const added = [];
    try {
      for (const file of files) {
        Ui.say(`Reading ${file.name} …`);
        added.push((await Api.post(path(`files?name=${encodeURIComponent(file.name)}`), file)).name);
      }
      if (draft.opened) { await readTraces(); afterChange(); } else await ask();
    } catch (error) {
      Ui.say('');
      for (const name of added) await Api.post(path(`remove?name=${encodeURIComponent(name)}`));
      if (!draft.state && !draft.opened) reset();
      throw error;
    }
    Ui.say(`${added.length} ${added.length === 1 ? 'file is' : 'files are'} read.`);
  });

  const reset = () => {
    Object.assign(draft, {id: '', opened: false, answers: new Map(), state: null, traces: [], edited: false, made: ''});
    $('problem').value = '';
    for (const id of ['data', 'ask', 'make']) show(id, false);
  };

  const discard = (name) => Ui.guard(async () => {
    await Api.post(path(`remove?name=${encodeURIComponent(name)}`));
    draft.answers.clear();
    if (draft.state.files.length > 1) await ask(); else reset();
  });

  // --- questions -----------------------------------------------------------------------------------
  let questioned = 0, settled = 0;
  const ask = async () => {
    const turn = ++questioned;
    const given = [...draft.answers].map(([id, value]) => ({key: id.slice(0, id.lastIndexOf('-')), file: +id.slice(id.lastIndexOf('-') + 1), value}));
    const state = await Api.post(path('questions'), JSON.stringify(given));
    if (turn < settled) return;
    settled = turn;
    draft.state = state;
    draft.traces = draft.state.files.map((file) => file.trace).filter(Boolean);
    show('data'); show('ask'); $('fresh').hidden = false;
    showQuestions();
    if (draft.state.problem !== null) takeProblem(draft.state.problem);
    showCards();
  };

  const field = (question) => {
    const id = `${question.key}-${question.file}`;
    const value = draft.answers.get(id) ?? question.value ?? question.guess;
    const columns = draft.state.files[question.file].columns;
    const options = question.key.endsWith('-column') && columns.length ? columns.map((name) => [name, name]) : kChoices[question.key];
    const choice = {yes: 'diameter', no: 'radius'};
    const hint = question.value === null && question.guess ? `Taken: ${question.why}.` : (options ? '' : question.accepted);
    const attributes = {id, name: id, 'aria-describedby': `${id}-hint`, 'aria-invalid': question.error ? 'true' : null, onchange: (event) => {
      draft.answers.set(id, event.target.value);
      Ui.guard(ask)();
    }};
    const input = options
      ? el('select', attributes, ...(value === '' ? [el('option', {value: ''}, 'choose …')] : []),
        ...options.map(([key, text]) => el('option', {value: key, selected: key === (choice[value] ?? value)}, text)))
      : el('input', {...attributes, value, placeholder: question.accepted});
    return el('div', {class: question.open ? 'field open' : 'field'}, el('label', {for: id}, question.words),
      question.picture ? el('pre', {tabindex: 0, role: 'group', 'aria-label': 'Drawing'}, question.picture) : null, input,
      el('p', {class: 'hint', id: `${id}-hint`}, hint), question.error ? el('p', {class: 'error'}, question.error) : null);
  };

  // What is being typed stays, where it is, when the page around it is made anew.
  const keepFocus = (work) => {
    const {id, value, type, selectionStart} = document.activeElement || {};
    work();
    const again = id && $(id);
    if (!again || document.activeElement === again) return;
    if (typeof value === 'string' && type !== 'checkbox') again.value = value;
    again.focus();
    if (typeof selectionStart === 'number') again.setSelectionRange(selectionStart, selectionStart);
  };

  const showQuestions = () => keepFocus(() => {
    const {questions, files} = draft.state;
    const asked = questions.filter((question) => !kData.includes(question.key));
    const groups = files.map((file, i) => [file.name, asked.filter((question) => question.of_file && question.file === i)]);
    groups.push(['The machine', asked.filter((question) => !question.of_file)]);
    const open = questions.filter((question) => question.open).length;
    $('questions').replaceChildren(
      el('p', {class: open ? 'warn' : 'good'}, open ? `${open} ${open === 1 ? 'question is' : 'questions are'} open.` : 'Nothing is open.'),
      ...groups.filter(([, group]) => group.length).map(([name, group]) =>
        el('fieldset', {}, el('legend', {}, name), el('div', {class: 'fields'}, ...group.map(field)))));
  });

  // --- what was read -------------------------------------------------------------------------------
  const edit = (name, unit) => ({
    get: (key) => Toml.profile($('problem').value, name, key),
    set: (...pairs) => {
      let text = $('problem').value;
      const isPart = pairs.some((value, i) => i % 2 === 1 && value !== null);
      if (isPart && Toml.profile(text, name, 'position_unit') === null) text = Toml.setProfile(text, name, 'position_unit', `"${unit}"`);
      for (let i = 0; i < pairs.length; i += 2) text = Toml.setProfile(text, name, pairs[i], pairs[i + 1]);
      changeProblem(text);
      showCards();
    }});

  const showCards = () => keepFocus(() => {
    const boxes = [];
    const ofFile = (i) => (draft.state ? draft.state.questions.filter((question) => question.file === i && kData.includes(question.key)) : []);
    const answer = (i, key) => { const found = ofFile(i).find((question) => question.key === key); return found ? found.value ?? found.guess : ''; };
    const cards = (draft.state ? draft.state.files : draft.traces.map((trace) => ({name: trace.name, trace}))).map((file, i) => {
      const facts = file.format ? `${file.file}: ${file.format}${file.decision ? '; ' + file.decision : ''}` : '';
      const unit = (which) => (file.format ? answer(i, `${which}-unit`) : file.trace[`${which}_unit`]);
      const label = (which) => `${which}, ${unit(which).replace(/^um$/, 'µm')}`;
      let plot = '';
      if (file.trace) {
        plot = Plots.draw(file.trace, label('position'), label('value'), $('problem').value ? edit(file.trace.name, unit('position')) : null);
        boxes.push(plot);
      }
      return el('div', {class: 'card'}, el('h3', {}, file.name), el('p', {class: 'hint'}, facts),
        file.trace ? el('p', {class: 'hint'}, `${file.trace.readings} readings${file.trace.missing ? `, ${file.trace.missing} missing` : ''}. Drag over the plot to look closer; a double click shows all.`) : '',
        el('div', {class: 'fields'}, ...ofFile(i).map(field)), plot,
        file.format ? el('button', {type: 'button', 'aria-label': `Remove ${file.name}`, onclick: discard(file.file)}, 'Remove') : '');
    });
    $('cards').replaceChildren(...cards);
    for (const box of boxes) box.start();
  });

  // --- the problem ---------------------------------------------------------------------------------
  const takeProblem = (text) => {
    draft.made = text;
    $('anew').hidden = !(draft.edited && text !== $('problem').value);
    if (draft.edited) return;
    $('problem').value = text;
    if (!$('name').value) $('name').value = draft.state ? draft.state.files[0].name : '';
    show('make');
    afterChange();
  };

  const changeProblem = (text) => {
    draft.edited = true;
    $('problem').value = text;
    afterChange();
  };

  let waiting = 0, asked = 0;
  const afterChange = () => {
    showTools();
    clearTimeout(waiting);
    waiting = setTimeout(Ui.guard(check), 400);
  };

  const check = async () => {
    const turn = ++asked;
    let found;
    try { found = await Api.post(path('check'), $('problem').value); } catch (error) { found = {faults: [{message: error.message}], assumed: [], design: null}; }
    if (turn === asked) showCheck(found);
  };

  const plainName = (name) => (choices.effects.find((each) => each.name === name) || {plain_name: name}).plain_name;

  const showCheck = ({faults, assumed, design}) => {
    const fault = (each) => el('li', {class: 'bad'}, each.message,
      each.excerpt ? el('pre', {tabindex: 0, role: 'group', 'aria-label': 'Where it stands'}, `${each.line} | ${each.excerpt}\n${' '.repeat(String(each.line).length)} | ${' '.repeat(each.column - 1)}${'^'.repeat(Math.max(each.length, 1))}`) : null);
    const parts = [];
    const list = (title, items) => { if (items.length) parts.push(el('h3', {}, title), el('ul', {}, ...items.map((item) => el('li', {}, item)))); };
    parts.push(el('p', {class: faults.length ? 'bad' : 'good'}, faults.length ? `${faults.length} ${faults.length === 1 ? 'fault' : 'faults'}` : 'No fault.'));
    if (faults.length) parts.push(el('ul', {}, ...faults.map(fault)));
    if (design) {
      list('These profiles determine', [design.identifiable.join(', ') || 'no parameter of the declared model']);
      const open = new Map();
      for (const {combination, advice} of design.unidentifiable) open.set(advice, [...(open.get(advice) || []), ...Object.keys(combination)]);
      list('They do not determine', [...open].map(([advice, names]) => `${names.join(', ')}: ${advice}`));
      const lacking = design.candidates.filter((each) => each.needs).map((each) => `${plainName(each.effect)} needs ${each.needs}`);
      if (lacking.length) parts.push(el('details', {}, el('summary', {}, `${lacking.length} effects cannot be looked for`), el('ul', {}, ...lacking.map((text) => el('li', {}, text)))));
    }
    if (assumed.length)
      parts.push(el('details', {}, el('summary', {}, `${assumed.length} assumed`), el('ul', {}, ...assumed.map((each) => el('li', {}, `${each.key} = ${JSON.stringify(each.value)} (${each.why})`)))));
    $('check').replaceChildren(...parts);
    $('run').disabled = faults.length > 0 || job !== '';
  };

  const showTools = () => keepFocus(() => {
    const text = $('problem').value;
    const declared = Toml.names(text, '[[effect]]');
    const box = (id, label, checked, change) => el('label', {for: id}, el('input', {type: 'checkbox', id, checked, onchange: (event) => changeProblem(change(event.target.checked))}), label);
    $('effects').replaceChildren(el('legend', {}, 'Declared'), ...choices.effects.map(({name, plain_name: plain, degree}) => box(`effect-${name}`, plain, declared.includes(name), (isIn) => (isIn
      ? Toml.add($('problem').value, ['[[effect]]', `name = "${name}"`, ...(degree === undefined ? [] : [`degree = ${degree}`])])
      : Toml.remove($('problem').value, '[[effect]]', name)))));
    $('spikes').replaceChildren(...Toml.names(text, '[[profile]]').map((name, i) => box(`spikes-${i}`, `leave out the spikes of ${name}`, Toml.profile(text, name, 'leave_out') === 'spikes',
      (isOut) => Toml.setProfile($('problem').value, name, 'leave_out', isOut ? '"spikes"' : null))));
  });

  const addFormula = (event) => {
    event.preventDefault();
    const given = Object.fromEntries(new FormData(event.target));
    const quoted = (word) => JSON.stringify(word);
    const parameters = given.parameters.split(',').map((each) => each.trim().split(/\s+/)).map(([name, unit = '1', lower, upper]) =>
      `{ name = ${quoted(name)}, unit = ${quoted(unit)}${lower === undefined ? '' : `, lower = ${+lower}`}${upper === undefined ? '' : `, upper = ${+upper}`} }`);
    changeProblem(Toml.add($('problem').value, ['[[trace.candidate]]', 'name = "formula"', `as = ${quoted(given.as)}`, `formula = ${quoted(given.formula)}`, `parameters = [ ${parameters.join(', ')} ]`]));
    event.target.reset();
  };

  // --- runs ----------------------------------------------------------------------------------------
  const run = Ui.guard(async () => {
    Ui.say('');
    job = (await Api.post(path(`run?name=${encodeURIComponent($('name').value || 'run')}`), $('problem').value)).job;
    setWorking(true);
    try { await follow(); } finally { job = ''; setWorking(false); }
  });

  const setWorking = (isWorking) => {
    $('run').disabled = isWorking;
    $('cancel').hidden = $('working').hidden = !isWorking;
    $('progress').textContent = '';
    if (isWorking) $('cancel').focus();
  };

  const follow = async () => {
    for (;;) {
      const state = await Api.get(`jobs/${job}`);
      $('progress').textContent = state.progress || `${state.seconds.toFixed(0)} s`;
      if (state.state === 'done') return finished(state);
      if (state.state === 'cancelled') { $('run').focus(); return Ui.say('The run was cancelled; nothing of it is kept.'); }
      if (state.state === 'failed') throw new Error(`The run failed: ${state.message}`);
      await new Promise((resolve) => setTimeout(resolve, 250));
    }
  };

  const finished = async (state) => {
    Ui.say(`The run ${state.run} is whole, after ${state.seconds.toFixed(1)} s.`);
    const before = last;
    last = state.run;
    await list();
    Results.showReport(state.run, choices.tables);
    if (before) { $('a').value = before; $('b').value = last; await compare(); }
    steps();
  };

  const compare = Ui.guard(() => Results.showDiff($('a').value, $('b').value));

  const open = Ui.guard(async (which, what) => {
    if (what === 'report') { last = which.name; Results.showReport(which.name, choices.tables); return steps(); }
    reset();
    const opened = await Api.post(`runs/${encodeURIComponent(which.name)}/open`);
    draft.id = opened.id;
    last = which['result.json'] ? which.name : '';
    $('name').value = which.name;
    takeProblem(opened.problem);
    draft.edited = draft.opened = true;
    $('fresh').hidden = false;
    Ui.say(`${which.name} is open; a run of it gets a folder of its own.`);
    await readTraces().catch(Ui.fail);
    $('make').scrollIntoView();
  });

  const readTraces = async () => {
    draft.traces = await Api.post(path('traces'), $('problem').value);
    show('data', draft.traces.length > 0);
    showCards();
  };

  const list = async () => {
    const found = await Api.get('runs');
    runs = found.runs;
    $('folder').textContent = found.folder;
    Results.showRuns(runs, open);
    Results.showBatches(found.batches, Ui.guard);
    const whole = runs.filter((each) => each['result.json']);
    for (const [id, at] of [['a', 1], ['b', 0]]) {
      const chosen = $(id).value;
      $(id).replaceChildren(...whole.map((each) => el('option', {}, each.name)));
      $(id).value = whole.some((each) => each.name === chosen) ? chosen : (whole[at] || {name: ''}).name;
    }
    show('compare', whole.length > 1);
  };

  // --- the page ------------------------------------------------------------------------------------
  $('files').addEventListener('change', async (event) => { await upload([...event.target.files]); event.target.value = ''; });
  for (const kind of ['dragenter', 'dragover', 'dragleave', 'drop'])
    document.addEventListener(kind, (event) => {
      event.preventDefault();
      $('drop').classList.toggle('over', kind === 'dragenter' || kind === 'dragover');
      if (kind === 'drop') upload([...event.dataTransfer.files]);
    });
  $('fresh').addEventListener('click', () => { reset(); $('name').value = ''; $('fresh').hidden = true; $('files').focus(); });
  $('questions').addEventListener('submit', (event) => event.preventDefault());
  $('problem').addEventListener('input', () => { draft.edited = true; afterChange(); });
  $('problem').addEventListener('change', showCards);
  $('anew').addEventListener('click', () => { draft.edited = false; takeProblem(draft.made); showCards(); });
  $('formula').addEventListener('submit', addFormula);
  $('run').addEventListener('click', run);
  $('cancel').addEventListener('click', Ui.guard(() => Api.post(`jobs/${job}/cancel`)));
  for (const id of ['a', 'b']) $(id).addEventListener('change', compare);
  Ui.guard(async () => { choices = await Api.get('choices'); await list(); steps(); })();
})();
