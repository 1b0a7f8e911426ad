// Elements of the page: made, changed, kept.

export const part = (id) => document.getElementById(id);

// An element with words, attributes and children.
export function made(tag, words = "", more = {}, ...children) {
  const node = document.createElement(tag);
  if (words !== "") node.textContent = words;
  for (const [key, value] of Object.entries(more)) {
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (key in node) node[key] = value;
    else node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}

export function put(node, words) {
  if (node.textContent !== String(words)) node.textContent = words;
}

export function mark(node, name, value) {
  if (node.getAttribute(name) !== String(value)) node.setAttribute(name, value);
}

// Children by their keys: one that is there is changed, not made anew, so that it keeps the focus.
export function rows(parent, keys, make) {
  const known = new Map([...parent.children].map((node) => [node.dataset.key, node]));
  const wanted = keys.map((key) => known.get(String(key)) ?? make(key));
  keys.forEach((key, k) => { wanted[k].dataset.key = key; });
  if (wanted.length !== parent.children.length
    || wanted.some((node, k) => node !== parent.children[k])) parent.replaceChildren(...wanted);
  return wanted;
}

// A button that stays: pressed or not.
export function toggle(button, changed, on = false) {
  const set = (pressed) => mark(button, "aria-pressed", pressed);
  set(on);
  button.addEventListener("click", () => {
    const pressed = button.getAttribute("aria-pressed") !== "true";
    set(pressed);
    changed(pressed);
  });
  return set;
}

// A choice of [value, words].
export function choice(select, options, chosen) {
  select.replaceChildren(...options.map(([value, words]) => made("option", words, { value })));
  if (chosen !== undefined) select.value = chosen;
}

export function download(name, data, kind = "application/octet-stream") {
  const link = made("a", "", { href: URL.createObjectURL(new Blob([data], { type: kind })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
