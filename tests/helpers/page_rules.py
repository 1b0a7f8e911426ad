"""What a page must keep so that everyone can read and reach it: measured in a browser."""

# Four rules for people who see little, hear the page read, or have no mouse.
RULES = """() => {
  const all = [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility());
  const name = (e) => `${e.tagName}#${e.id}.${e.className} ${e.textContent.slice(0, 30)}`;
  const plain = new Set(["I", "B", "SPAN", "DIV", "P", "SMALL", "KBD", "CODE", "TIME", "TD"]);
  const labelled = all.filter((e) => e.ariaLabel && plain.has(e.tagName) && !e.role);
  const lists = all.filter((e) => e.tagName === "DL").flatMap((dl) => [...dl.children])
    .flatMap((e) => e.tagName === "DIV" ? [...e.children] : [e])
    .filter((e) => !["DT", "DD"].includes(e.tagName));
  const focusable = (e) => [e, ...e.querySelectorAll("*")].some((x) => x.tabIndex >= 0);
  const scrolling = all.filter((e) => /auto|scroll/.test(getComputedStyle(e).overflowY)
    && e.scrollHeight > e.clientHeight + 1 && !focusable(e));

  const dot = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  dot.canvas.width = dot.canvas.height = 1;
  const over = (colour, alpha, below) => {  // what a colour looks like on another
    dot.globalAlpha = 1;
    dot.fillStyle = `rgb(${below})`;
    dot.fillRect(0, 0, 1, 1);
    dot.globalAlpha = alpha;
    dot.fillStyle = colour;
    dot.fillRect(0, 0, 1, 1);
    return [...dot.getImageData(0, 0, 1, 1).data].slice(0, 3);
  };
  const ground = (e) => e === null ? [255, 255, 255]
    : over(getComputedStyle(e).backgroundColor, 1, ground(e.parentElement));
  const faint = (e) => e === null ? 1
    : Number(getComputedStyle(e).opacity) * faint(e.parentElement);
  const light = (c) => c.map((v) => v / 255)
    .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const words = all.filter((e) => !e.closest(":disabled") && e.tagName !== "OPTION"
    && [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()));
  const pale = words.map((e) => {
    const style = getComputedStyle(e), behind = ground(e);
    const shown = over(style.color, faint(e), behind);
    const pair = [light(shown), light(behind)].sort((a, b) => b - a);
    const large = parseFloat(style.fontSize) >= (style.fontWeight >= 700 ? 18.66 : 24);
    return [name(e), (pair[0] + 0.05) / (pair[1] + 0.05) / (large ? 3 : 4.5)];
  }).filter(([, share]) => share < 1);
  return { words: words.length, wrong: { labelled: labelled.map(name), lists: lists.map(name),
    scrolling: scrolling.map(name), pale } };
}"""
