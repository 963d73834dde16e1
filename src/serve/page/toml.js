'use strict';

// Makes elements of text alone: nothing that comes from a file is ever read as markup.
const el = (tag, attributes = {}, ...children) => {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, '');
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
};
const $ = (id) => document.getElementById(id);

// Changes single keys and tables of a problem file and leaves all else as it stands.
const Toml = (() => {
  const isHead = (line) => /^\s*\[/.test(line);
  const isEmpty = (line) => /^\s*(#.*)?$/.test(line);

  // Tables with their lines; comments in front of a table belong to it.
  const tables = (text) => {
    const lines = text.split('\n');
    const found = [];
    let depth = 0;
    lines.forEach((line, i) => {
      const code = line.replace(/"(\\.|[^"\\])*"|'[^']*'/g, '""').replace(/#.*/, '');
      if (depth === 0 && isHead(code)) found.push({head: code.trim(), first: i, keys: {}});
      const table = found[found.length - 1];
      const key = depth === 0 && !isHead(code) && /^\s*([\w-]+)\s*=/.exec(code);
      if (key && table) table.keys[key[1]] = [i, i + 1];
      if (!isHead(code) || depth > 0) {
        depth = Math.max(0, depth + (code.match(/[[{]/g) || []).length - (code.match(/[\]}]/g) || []).length);
        const last = table && Object.values(table.keys).pop();
        if (last && code.trim()) last[1] = i + 1;
      }
    });
    found.forEach((table, i) => {
      table.last = i + 1 < found.length ? found[i + 1].first : lines.length;
      while (table.last > table.first + 1 && isEmpty(lines[table.last - 1])) --table.last;
    });
    return {lines, found};
  };

  const value = (parsed, table, key) => {
    if (!table.keys[key]) return null;
    const [first, last] = table.keys[key];
    const text = parsed.lines.slice(first, last).map((line) => line.replace(/\s+#[^"']*$/, '')).join(' ');
    const raw = text.slice(text.indexOf('=') + 1).trim();
    try { return JSON.parse(raw.replace(/,\s*\]/g, ']')); } catch { return raw.replace(/^['"]|['"]$/g, ''); }
  };

  const called = (parsed, head, name) => parsed.found.find((table) => table.head === head && value(parsed, table, 'name') === name);

  // The keys of a [[profile]]; null where the text has none of that name.
  const profile = (text, name, key) => {
    const parsed = tables(text);
    const table = called(parsed, '[[profile]]', name);
    return table ? value(parsed, table, key) : null;
  };

  const setProfile = (text, name, key, raw) => {
    const parsed = tables(text);
    const table = called(parsed, '[[profile]]', name);
    if (!table) return text;
    const [first, last] = table.keys[key] || [table.last, table.last];
    parsed.lines.splice(first, last - first, ...(raw === null ? [] : [`${key} = ${raw}`]));
    return parsed.lines.join('\n');
  };

  const names = (text, head) => {
    const parsed = tables(text);
    return parsed.found.filter((table) => table.head === head).map((table) => value(parsed, table, 'name'));
  };

  const remove = (text, head, name) => {
    const parsed = tables(text);
    const table = called(parsed, head, name);
    if (table) parsed.lines.splice(table.first, table.last - table.first);
    return parsed.lines.join('\n').replace(/\n{3,}/g, '\n\n');
  };

  // At the end, where a table ends no other.
  const add = (text, lines) => text.replace(/\s*$/, '\n\n') + lines.join('\n') + '\n';

  return {profile, setProfile, names, remove, add};
})();
