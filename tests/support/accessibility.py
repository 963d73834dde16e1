"""The rules of WCAG 2.1, AA, that a program can check, on the page a browser shows."""

import pathlib

PAGE = (pathlib.Path(__file__).parent / "accessibility.js").read_text(encoding="utf-8")
TAB = "\ue004"
# Roles of ARIA that are nothing without a name (1.1.1, 2.4.4, 4.1.2).
NAMED = {"alert dialog", "button", "checkbox", "combobox", "dialog", "form", "heading", "Iframe",
         "image", "img", "link", "listbox", "meter", "progressbar", "radio", "region", "slider",
         "spinbutton", "switch", "tab", "table", "textbox", "searchbox"}
# What of an element a focus may change to be seen (2.4.7).
FOCUS = """
  const e = document.activeElement;
  if (!e || e === document.body || e.tagName === 'IFRAME') return null;
  const look = () => { const s = getComputedStyle(e); return [s.outlineStyle === 'none' ? '' :
    s.outlineWidth + s.outlineColor, s.boxShadow, s.borderColor, s.backgroundColor].join(); };
  if (e.matches('input[type=file]')) return ['', true];
  const focused = look();
  e.blur(); const plain = look(); e.focus({focusVisible: true, preventScroll: true});
  return [e.outerHTML.replace(/\\s+/g, ' ').slice(0, 90), focused !== plain];"""

INERT = "for (const frame of document.querySelectorAll('iframe')) frame.inert = arguments[0];"


def without_a_name(browser):
    return [f"a {node['role']['value']} without a name: {node.get('backendDOMNodeId')}"
            for node in browser.tool("Accessibility.getFullAXTree")["nodes"]
            if not node["ignored"] and node["role"]["value"] in NAMED
            and not str(node.get("name", {}).get("value", "")).strip()]


def unseen_focus(browser, most=40):
    """Goes through the page by the tabulator key, but not into what it frames."""
    unseen, seen = [], set()
    browser.run("document.activeElement.blur(); window.scrollTo(0, 0); " + INERT, True)
    for _ in range(most):
        browser.keys(TAB)
        found = browser.run(FOCUS)
        if found is None or tuple(found) in seen:
            continue
        seen.add(tuple(found))
        if not found[1]:
            unseen.append(f"focus is not seen: {found[0]}")
    browser.run(INERT, False)
    return unseen


def breaches(browser, schemes=("light", "dark")):
    """One line for each breach, in a light and a dark scheme."""
    out = without_a_name(browser)
    for scheme in schemes:
        browser.tool("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": scheme}])
        out += [f"{scheme}: {line}" for line in browser.run(PAGE)]
    browser.tool("Emulation.setEmulatedMedia", features=[])
    return out + unseen_focus(browser)
