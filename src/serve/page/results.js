// Runs, their comparison, and results of batches.
const Results = (() => {
  const kVerdicts = {explained: ['Explained', 'good'], nothing_missing: ['Nothing missing', 'good'], ambiguous: ['Ambiguous', 'warn'],
    unnamed: ['Something without a name', 'warn'], not_identifiable: ['Not identifiable', 'bad']};
  const kSmall = 1e-3;
  const number = (value, digits = 4) => {
    if (typeof value !== 'number') return '–';
    const isSmall = value !== 0 && Math.abs(value) < kSmall;
    return (isSmall ? value.toExponential(digits - 1) : String(+value.toPrecision(digits))).replace(/-/g, '−');
  };
  const withU = (value, U, scale = 1) => {
    if (typeof value !== 'number') return '–';
    if (typeof U !== 'number' || U <= 0) return number(value * scale);
    if (Math.max(Math.abs(value), U) * scale < kSmall) {
      const power = Math.floor(Math.log10(Math.max(Math.abs(value), U) * scale));
      const raised = String(power).replace(/./g, (digit) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(digit)]);
      return `(${withU(value, U, scale / 10 ** power)}) × 10${raised}`;
    }
    const decimals = Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(U * scale))));
    return `${(value * scale).toFixed(decimals)} ± ${(U * scale).toFixed(decimals)}`;
  };
  const verdict = (name) => {
    const [text, kind] = kVerdicts[name] || [name ? name.replace(/_/g, ' ') : '–', ''];
    return el('span', {class: kind}, text);
  };
  const when = (seconds) => new Date(seconds * 1000).toLocaleString(undefined, {dateStyle: 'short', timeStyle: 'short'});

  // Columns: [heading, is a number, cell of a row]; the first cell names its row.
  const table = (caption, columns, rows, classOf = () => null) => el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption},
    el('table', {}, el('caption', {}, caption),
      el('thead', {}, el('tr', {}, ...columns.map(([heading, isNumber]) => el('th', {scope: 'col', class: isNumber ? 'n' : null}, heading)))),
      el('tbody', {}, ...rows.map((row) => el('tr', {class: classOf(row)}, ...columns.map(([, isNumber, cell], i) =>
        el(i ? 'td' : 'th', {class: isNumber ? 'n' : null, scope: i ? null : 'row'}, cell(row))))))));

  const briefColumns = [
    ['Verdict', false, (row) => verdict(row.verdict)],
    ['Effects', false, (row) => (row.effects || []).join(', ') || '–'],
    ['E_ZX, µm', true, (row) => withU(row.straightness_um, row.straightness_U_um)],
    ['Squareness, µm/m', true, (row) => withU(row.squareness_rad, row.squareness_U_rad, 1e6)],
    ['Residual, µm', true, (row) => number(row.rms_um, 3)]];

  const showRuns = (list, open) => {
    const actions = (run) => {
      const button = (text, what) => el('button', {type: 'button', 'aria-label': `${text} ${run.name}`, onclick: () => open(run, what)}, text);
      return el('span', {class: 'bar'}, run['report.html'] || run['result.json'] ? button('Report', 'report') : null, run['problem.toml'] ? button('Change', 'change') : null);
    };
    $('runs').replaceChildren(list.length ? table('Newest first', [
      ['Run', false, (run) => run.name], ['Title', false, (run) => run.title || '–'], ...briefColumns,
      ['Written', false, (run) => when(run.seconds)], ['Open', false, actions]], list) : el('p', {class: 'hint'}, 'None yet.'));
  };

  const showDiff = async (a, b) => {
    if (!a || !b || a === b) return $('diff').replaceChildren(el('p', {class: 'hint'}, 'Choose two different runs.'));
    const {a: first, b: second, diff} = await Api.get(`diff?a=${encodeURIComponent(a)}&b=${encodeURIComponent(b)}`);
    const summary = table('What each says', [
      ['Run', false, (row) => row.name], ...briefColumns], [{name: `A: ${a}`, ...first}, {name: `B: ${b}`, ...second}]);
    const far = (row) => typeof row.En === 'number' && row.En > 1;
    const parameters = table('Parameters of the final models; marked where they differ by more than their uncertainties', [
      ['Parameter', false, (row) => `${row.symbol} ${row.name}`], ['A', true, (row) => number(row.a, 6)], ['B', true, (row) => number(row.b, 6)],
      ['B − A', true, (row) => number(row.difference, 3)], ['U', true, (row) => number(row.expanded_uncertainty, 2)],
      ['Eₙ', true, (row) => number(row.En, 3)], ['Unit', false, (row) => (row.unit === '1' ? '' : row.unit)]],
      diff.parameters.filter((row) => row.a !== null || row.b !== null), (row) => (far(row) ? 'far' : null));
    const changes = table('What else is not the same', [['What', false, (row) => row.what],
      ['A', false, (row) => String(row.a ?? '–')], ['B', false, (row) => String(row.b ?? '–')]], diff.changes);
    $('diff').replaceChildren(summary, parameters, diff.changes.length ? changes : '');
  };

  const kTrends = [['squareness', 'squareness, µm/m', 'squareness_rad', 'squareness_U_rad', 1e6],
    ['E_ZX', 'E_ZX, µm', 'straightness_um', 'straightness_U_um', 1]];
  const kMostPoints = 2000;

  // What the items of a machine say together, as the pooling of the batch has it.
  const together = (machine) => {
    const apart = machine.items.filter((item) => !item.fits);
    const parts = [`${machine.items.length - apart.length} of ${machine.items.length} items fit together`];
    if (apart.length) parts.push(`${apart.map((item) => `${item.id} (Eₙ ${number(item.En, 2)})`).join(', ')} ${apart.length === 1 ? 'does' : 'do'} not`);
    if (machine.left_out.length) parts.push(`declared otherwise: ${machine.left_out.join(', ')}`);
    for (const trend of machine.trends)
      parts.push(`${trend.parameter}: ${withU(trend.rate, trend.expanded_uncertainty)} ${trend.unit}, p = ${number(trend.p_value, 2)}`);
    return parts.join('; ') + '.';
  };

  // One plot for each machine and quantity; a point opens its report.
  const trends = (rows, open) => {
    const machines = new Map();
    for (const row of rows.slice(0, kMostPoints)) {
      const machine = row.machine || 'no machine named';
      machines.set(machine, [...(machines.get(machine) || []), row]);
    }
    return [...machines].flatMap(([machine, all]) => kTrends.flatMap(([name, label, key, uncertainty, scale]) => {
      const known = all.filter((row) => typeof row[key] === 'number');
      if (known.length < 2) return [];
      const byDate = known.every(({time}) => /^\d{4}-\d\d-\d\d/.test(time));
      const byTime = !byDate && known.every(({time}) => time !== '' && !Number.isNaN(+time));
      const at = (row) => (byDate ? Date.parse(row.time) : byTime ? +row.time : rows.indexOf(row) + 1);
      const points = known.map((row) => ({row, at: at(row), value: scale * row[key], U: scale * (row[uncertainty] || 0)}));
      return [Plots.trend({title: `${machine}: ${name}`, x: byDate ? 'date' : byTime ? 'time' : 'line of the results', y: label, points, byDate, open})];
    }));
  };

  const showBatch = async (name) => {
    const {rows, machines, lines, torn} = await Api.get(`batches/${encodeURIComponent(name)}`);
    const pooled = Array.isArray(machines) ? machines : [];
    const items = new Map(pooled.flatMap((machine) => machine.items.map((item) => [item.id, item])));
    for (const row of rows) row.pooled = items.get(row.id);
    const isApart = (row) => row.pooled && !row.pooled.fits;
    const open = (row) => row.has_report && showPage(`batches/${encodeURIComponent(name)}/report?id=${encodeURIComponent(row.id)}`, `${name}: ${row.id}`);
    const report = (row) => (row.has_report ? el('button', {type: 'button', 'aria-label': `Report ${row.id}`, onclick: () => open(row)}, 'Report') : '');
    const plots = trends(rows, open);
    const note = `${lines} lines${torn ? `, ${torn} not whole` : ''}${rows.some(isApart) ? '; marked: does not fit the other items of its machine' : ''}`;
    $('batch').replaceChildren(
      ...pooled.map((machine) => el('p', {}, el('b', {}, machine.machine), ': ', together(machine))),
      Array.isArray(machines) ? '' : el('p', {class: 'warn'}, machines),
      el('div', {class: 'trends'}, ...plots), table(`${name}: ${note}`, [
      ['Item', false, (row) => row.id], ['Machine', false, (row) => row.machine || '–'], ['Time', false, (row) => el('span', {class: 'whole'}, row.time || '–')],
      ['Status', false, (row) => (row.status === 'ok' ? 'ok' : el('span', {class: 'bad', title: row.reason}, `${row.status}: ${row.reason}`))],
      ['Eₙ', true, (row) => (row.pooled ? number(row.pooled.En, 2) : '–')],
      ...briefColumns, ['Page', false, report]], rows, (row) => (isApart(row) ? 'far' : null)));
    for (const plot of plots) plot.start();
  };

  const showBatches = (names, guard) => $('batches').replaceChildren(...(names.length ? [
    el('h3', {}, 'Results of batches'),
    el('p', {class: 'bar'}, ...names.map((name) => el('button', {type: 'button', onclick: guard(() => showBatch(name))}, name))),
    el('div', {id: 'batch'})] : []));

  const showPage = (address, title) => {
    $('result').hidden = false;
    $('result-h').textContent = `Report: ${title}`;
    $('downloads').replaceChildren();
    $('page').src = address;
    $('result-h').focus();
    $('result').scrollIntoView();
  };

  const showReport = (name, formats) => {
    const base = `runs/${encodeURIComponent(name)}/`;
    showPage(base + 'report.html', name);
    const link = (text, address) => el('a', {href: base + address, download: true}, text);
    const format = el('select', {'aria-label': 'Control'}, ...formats.map((each) => el('option', {}, each)));
    $('downloads').replaceChildren(
      'Download: ', link('problem.toml', 'problem.toml'), link('result.json', 'result.json'), link('report.html', 'report.html?download=1'),
      el('a', {href: base + 'report.html', target: '_blank', rel: 'noopener'}, 'Open alone, to print'),
      el('span', {}, 'Compensation table ', format, ' ',
        el('button', {type: 'button', onclick: () => Api.save(`${base}table?to=${format.value}`)}, 'Download table')));
  };

  return {showRuns, showBatches, showDiff, showReport};
})();
