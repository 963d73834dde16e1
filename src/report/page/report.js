// Draws the long profiles with zoom, from the numbers that stand beside their SVG.
(() => {
  'use strict';
  const root = document.documentElement;
  const dash = {raw: null, low: null, before: [7, 4], after: null};
  const width = {raw: 0.9, low: 1.3, before: 1.7, after: 1.7};
  const colour = (name) => getComputedStyle(root).getPropertyValue('--' + name).trim();
  const colours = (data) => ({
    colors: data.series.map((one) => colour(one.style)),
    axisLineColor: colour('soft'),
    gridLineColor: colour('line'),
  });
  const charts = [];

  const element = (tag, kind, parent) => {
    const made = document.createElement(tag);
    made.className = kind;
    parent.append(made);
    return made;
  };

  // Charts of one profile show the same part of the trace.
  const follow = (leader) => {
    for (const other of charts)
      if (other !== leader && other.profile === leader.profile)
        other.chart.updateOptions({dateWindow: leader.chart.xAxisRange()});
  };

  const draw = (figure) => {
    const data = JSON.parse(figure.querySelector('script').textContent);
    const box = element('div', 'chart', figure.firstElementChild);
    const button = element('button', '', box);
    const legend = element('div', 'legend', box);
    const plot = element('div', 'plot', box);
    button.type = 'button';
    button.textContent = 'Whole trace';
    plot.setAttribute('role', 'img');
    plot.setAttribute('aria-label', data.title);
    const own = {id: figure.id, profile: figure.id.split('-')[0], data};
    const series = {};
    for (const one of data.series)
      series[one.name] = {strokePattern: dash[one.style], strokeWidth: width[one.style], drawPoints: data.markers, pointSize: 2.5};
    own.chart = new Dygraph(plot, data.position.map((x, i) => [x, ...data.series.map((one) => one.values[i])]), {
      ...colours(data),
      labels: ['position', ...data.series.map((one) => one.name)],
      series,
      xlabel: data.x,
      ylabel: data.y,
      legend: 'always',
      labelsDiv: legend,
      axisLabelFontSize: 12,
      axes: {
        x: {valueFormatter: (x) => x.toPrecision(6) + ' mm'},
        y: {valueFormatter: (y) => y.toPrecision(4) + ' ' + data.unit, axisLabelFormatter: (y) => String(+y.toPrecision(4)), axisLabelWidth: 60},
      },
      zoomCallback: () => follow(own),
    });
    button.addEventListener('click', () => {
      own.chart.resetZoom();
      follow(own);
    });
    charts.push(own);
  };

  root.classList.add('js');
  document.querySelectorAll('figure.long').forEach(draw);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    for (const own of charts) own.chart.updateOptions(colours(own.data));
  });
  window.slideway = {charts};
})();
