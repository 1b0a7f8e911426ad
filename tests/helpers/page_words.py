"""Whether text on a page lies over other text, or is cut: measured in a browser, box by box."""

# What is wrong, in words. Boxes of letters are a little higher than the letters.
WORDS = """() => {
  const wrong = [], boxes = [], range = document.createRange();
  const told = (text) => text.trim().slice(0, 50);
  const inside = (element, box) => {
    let { left, right, top, bottom } = box;
    for (let e = element; e && e !== document.body; e = e.parentElement) {
      if (getComputedStyle(e).overflowX === "visible") continue;
      const own = e.getBoundingClientRect();
      [left, right] = [Math.max(left, own.left), Math.min(right, own.right)];
      [top, bottom] = [Math.max(top, own.top), Math.min(bottom, own.bottom)];
    }
    return { left, right, top, bottom };
  };
  const add = (element, box, text, whole) => {
    const { left, right, top, bottom } = inside(element, box);
    if (right - left < 3 || bottom - top < 3) return;
    const edge = Math.min(0.2 * (bottom - top), 3);
    boxes.push({ left: left + 1, right: right - 1, top: top + edge, bottom: bottom - edge, text,
      whole });
  };
  const shows = (e) => e.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const { currentNode: node, currentNode: { parentElement: e } } = walk;
    if (!node.data.trim() || e.closest("svg, script, style, option, select") || !shows(e)) continue;
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) add(e, box, told(node.data), node);
  }
  for (const e of document.querySelectorAll("svg text")) {
    if (!e.textContent.trim() || !shows(e)) continue;
    const box = e.getBoundingClientRect(), svg = e.ownerSVGElement.getBoundingClientRect();
    add(e, box, told(e.textContent), e);
    if (box.left < svg.left - 2 || box.right > svg.right + 2 || box.top < svg.top - 2
      || box.bottom > svg.bottom + 2) wrong.push(`cut: ${told(e.textContent)}`);
  }
  boxes.sort((a, b) => a.top - b.top);
  for (let k = 0; k < boxes.length; k++) {
    for (let n = k + 1; n < boxes.length && boxes[n].top < boxes[k].bottom; n++) {
      const [a, b] = [boxes[k], boxes[n]];
      if (a.whole !== b.whole && a.left < b.right && b.left < a.right) {
        wrong.push(`${a.text} | lies over | ${b.text}`);
      }
    }
  }
  if (boxes.length < 10) wrong.push("hardly any text");
  return wrong;
}"""
