// What the rules of WCAG 2.1, AA, that can be computed say of a page: one line for each breach.
const all = (selector) => [...document.querySelectorAll(selector)];
const shown = (element) => element.checkVisibility({checkOpacity: true, checkVisibilityCSS: true}) &&
  !element.closest('[aria-hidden=true]');
const mark = (element) => element.outerHTML.replace(/\s+/g, ' ').slice(0, 90);
const breaches = [];
const breach = (rule, elements) => {
  for (const element of elements) breaches.push(`${rule}: ${mark(element)}`);
};

// 3.1.1, 2.4.2, 1.4.4, and landmarks.
if (!document.documentElement.lang) breaches.push('the page has no language');
if (!document.title.trim()) breaches.push('the page has no title');
if (/user-scalable=no|maximum-scale/.test(document.querySelector('meta[name=viewport]')?.content))
  breaches.push('the page cannot be enlarged');
if (all('main').length !== 1) breaches.push(`${all('main').length} main landmarks`);
breach('outside every landmark', all('body > *').filter((e) => shown(e) && e.innerText?.trim() &&
  !e.matches('main, header, footer, nav, aside, .skip, script, style, dialog, section[aria-labelledby]')));

// 4.1.1, 1.3.1, 2.4.6.
const ids = all('[id]').map((e) => e.id);
breach('an id stands twice', all('[id]').filter((e) => ids.filter((id) => id === e.id).length > 1));
for (const attribute of ['aria-labelledby', 'aria-describedby', 'aria-controls', 'for'])
  breach(`${attribute} leads nowhere`, all(`[${attribute}]`).filter((e) =>
    e.getAttribute(attribute).split(/\s+/).some((id) => !document.getElementById(id))));
breach('a link leads nowhere', all('a[href^="#"]').filter((a) =>
  a.hash.length < 2 || !document.getElementById(decodeURIComponent(a.hash.slice(1)))));
let level = 0;
const headings = all('h1, h2, h3, h4, h5, h6').filter(shown);
breach('a level of heading is left out', headings.filter((heading) => {
  const before = level;
  level = +heading.tagName[1];
  return level > before + 1;
}));
if (headings.filter((heading) => heading.tagName === 'H1').length !== 1)
  breaches.push('not one heading of the first level');
breach('a table without header cells', all('table').filter((t) => !t.querySelector('th')));
breach('a header cell without scope', all('th:not([scope])'));
breach('a table without a name', all('table').filter((t) => !t.caption?.textContent.trim() &&
  !t.hasAttribute('aria-label') && !t.hasAttribute('aria-labelledby')));
breach('a list holds what is no item', all('ul > :not(li), ol > :not(li)'));
breach('out of the order of the page', all('[tabindex]').filter((e) => e.tabIndex > 0));
breach('what scrolls cannot be reached by keys', all('body *').filter((e) => shown(e) &&
  /auto|scroll/.test(getComputedStyle(e).overflowX) && e.scrollWidth > e.clientWidth + 1 &&
  e.tabIndex < 0 && !e.querySelector('a[href], button, input, select, textarea')));
breach('a control within a control', all('a[href], button').filter((e) =>
  e.querySelector('a[href], button, input, select, textarea')));

// 1.4.3: the colour of each text over all that lies under it.
const channels = (colour) => {
  const parts = colour.match(/[\d.]+(e-?\d+)?/g).map(Number);
  const scale = colour.startsWith('color(') ? 255 : 1;
  return [...parts.slice(0, 3).map((part) => part * scale), parts.length > 3 ? parts[3] : 1];
};
const over = (top, under) => [0, 1, 2].map((i) => top[3] * top[i] + (1 - top[3]) * under[i]);
const ground = (element) => {
  const layers = [];
  for (let e = element; e; e = e.parentElement) layers.push(channels(getComputedStyle(e).backgroundColor));
  const scheme = getComputedStyle(document.documentElement).colorScheme;
  const dark = scheme.includes('dark') && matchMedia('(prefers-color-scheme: dark)').matches;
  return layers.reverse().reduce((under, top) => over(top, under), dark ? [18, 18, 18] : [255, 255, 255]);
};
const luminance = (colour) => {
  const [r, g, b] = colour.map((part) => part / 255).map((part) =>
    (part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const contrast = (a, b) => {
  const [low, high] = [luminance(a), luminance(b)].sort((p, q) => p - q);
  return (high + 0.05) / (low + 0.05);
};
const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (texts.nextNode()) {
  const element = texts.currentNode.parentElement;
  if (!texts.currentNode.data.trim() || element.closest('script, style, noscript, :disabled, option') || !shown(element))
    continue;
  const style = getComputedStyle(element);
  const size = parseFloat(style.fontSize);
  const needed = size >= 24 || (size >= 18.66 && style.fontWeight >= 700) ? 3 : 4.5;
  const colour = channels(element instanceof SVGElement ? style.fill : style.color);
  for (let e = element; e; e = e.parentElement) colour[3] *= getComputedStyle(e).opacity;
  const under = ground(element);
  const ratio = contrast(over(colour, under), under);
  if (ratio < needed) breaches.push(`contrast ${ratio.toFixed(2)}: ${mark(element)}`);
}
return [...new Set(breaches)];
