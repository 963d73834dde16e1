// One plot a profile; a part of it can be chosen by dragging or by two numbers.
const Plots = (() => {
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
  const number = (value) => String(+value.toPrecision(6));
  const charts = new Map();
  // The legend of dygraphs writes style attributes, which the page's policy refuses.
  Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);

  const paintMasks = (parts) => (canvas, area, chart) => {
    const [least, most] = chart.xAxisExtremes();
    canvas.fillStyle = colour('mask');
    for (const [from, to] of parts(least, most)) {
      const left = Math.max(chart.toDomXCoord(from), area.x);
      const right = Math.min(chart.toDomXCoord(to), area.x + area.w);
      if (right > left) canvas.fillRect(left, area.y, right - left, area.h);
    }
  };

  // What a window and a mask leave out between two ends.
  const leftOut = (edit) => (least, most) => {
    const window_ = edit && edit.get('window');
    const mask = (edit && edit.get('mask')) || [];
    return [...mask, ...(Array.isArray(window_) ? [[least, window_[0]], [window_[1], most]] : [])];
  };

  // The plot and, with `edit` (get and set of a key of its profile), what changes the part that is used.
  const draw = (trace, x, y, edit) => {
    const plot = el('div', {class: 'plot', role: 'img', 'aria-label': `${trace.name}: ${trace.readings} readings of ${y} over ${x}`});
    const id = encodeURIComponent(trace.name);
    const from = el('input', {id: `from-${id}`, type: 'number', step: 'any', 'aria-label': `${trace.name}: from`});
    const to = el('input', {id: `to-${id}`, type: 'number', step: 'any', 'aria-label': `${trace.name}: to`});
    const shown = el('span', {class: 'hint'});
    const chosen = () => [+from.value, +to.value].sort((a, b) => a - b);
    const isChosen = () => from.value !== '' && to.value !== '' && from.value !== to.value;
    const act = (change) => () => { if (isChosen()) change(`[${chosen().join(', ')}]`); else from.focus(); };
    const masks = () => (edit.get('mask') || []).map((part) => `[${part.join(', ')}]`);
    const bar = el('div', {class: 'bar'},
      el('label', {}, 'From ', from), el('label', {}, 'to ', to),
      el('button', {type: 'button', onclick: act((part) => edit.set('window', part))}, 'Keep only this'),
      el('button', {type: 'button', onclick: act((part) => edit.set('mask', `[${[...masks(), part].join(', ')}]`))}, 'Leave this out'),
      el('button', {type: 'button', onclick: () => edit.set('window', null, 'mask', null)}, 'Use all'), shown);
    const box = el('div', {}, plot, edit ? bar : '');
    box.start = () => {
      const chart = new Dygraph(plot, trace.positions.map((at, i) => [at, trace.values[i]]), {
        labels: [x, y], xlabel: x, ylabel: y, colors: [colour('raw')], strokeWidth: 1,
        drawPoints: trace.positions.length < 100, pointSize: 2.5,
        axisLabelFontSize: 12, axisLineColor: colour('soft'), gridLineColor: colour('line'),
        axes: {y: {axisLabelWidth: 60, axisLabelFormatter: number}, x: {axisLabelFormatter: number}},
        underlayCallback: paintMasks(leftOut(edit)),
        highlightCallback: (event, at, points) => { shown.textContent = `${number(at)}: ${number(points[0].yval)}`; },
        zoomCallback: (least, most) => { from.value = number(least); to.value = number(most); },
      });
      charts.set(trace.name, chart);
    };
    return box;
  };

  // A quantity over the items of one machine, ± U; those that do not fit the others are crossed.
  const trend = ({title, x, y, points, byDate, open}) => {
    const apart = points.filter(({row}) => row.pooled && !row.pooled.fits).length;
    const plot = el('div', {class: 'plot', role: 'img', 'aria-label': `${title}: ${points.length} items over ${x}${apart ? `, ${apart} of them do not fit` : ''}`});
    const shown = el('p', {class: 'hint'}, 'A point opens its report.');
    const box = el('div', {}, el('h4', {}, title), plot, shown);
    const sorted = [...points].sort((a, b) => a.at - b.at);
    const mark = (chart, series, context, cx, cy, colour_, size, i) => {
      const {row, value, U} = sorted[i];
      const isApart = row.pooled && !row.pooled.fits;
      const line = (...way) => { context.beginPath(); way.forEach(([px, py], k) => (k ? context.lineTo(px, py) : context.moveTo(px, py))); context.stroke(); };
      context.strokeStyle = context.fillStyle = colour(isApart ? 'bad' : 'raw');
      context.lineWidth = isApart ? 2.5 : 1.2;
      line([cx, chart.toDomYCoord(value - U)], [cx, chart.toDomYCoord(value + U)]);
      if (isApart) { line([cx - 5, cy - 5], [cx + 5, cy + 5]); line([cx - 5, cy + 5], [cx + 5, cy - 5]); return; }
      context.beginPath(); context.arc(cx, cy, 3, 0, 2 * Math.PI); context.fill();
    };
    const ends = (sign) => sorted.map(({value, U}) => value + sign * U);
    box.start = () => charts.set(title, new Dygraph(plot, sorted.map(({at, value}) => [byDate ? new Date(at) : at, value]), {
      labels: [x, y], xlabel: x, ylabel: y, colors: [colour('raw')], strokeWidth: 0, drawPoints: true, pointSize: 5, highlightCircleSize: 6,
      axisLabelFontSize: 12, axisLineColor: colour('soft'), gridLineColor: colour('line'), xRangePad: 12,
      valueRange: widened(Math.min(...ends(-1)), Math.max(...ends(1))),
      axes: {y: {axisLabelWidth: 60, axisLabelFormatter: number}, x: byDate ? {} : {axisLabelFormatter: number}},
      drawPointCallback: mark, drawHighlightPointCallback: mark,
      highlightCallback: (event, at, hit, i) => { const {row, value, U} = sorted[i]; shown.textContent = `${row.id}: ${number(value)} ± ${number(U)}`; },
      pointClickCallback: (event, point) => open(sorted[point.idx].row),
    }));
    return box;
  };

  const widened = (least, most) => {
    const margin = 0.08 * (most - least) || 1;
    return [least - margin, most + margin];
  };

  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    for (const chart of charts.values()) chart.updateOptions({colors: [colour('raw')], axisLineColor: colour('soft'), gridLineColor: colour('line')});
  });
  return {draw, trend, charts};
})();
