function unpack(packed) {
  const text = atob(packed.bdata);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  return packed.dtype === "i4" ? new Int32Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

// Another magnification: points, hairs and outliers of the error are placed anew on the path.
ready.push(() => {
  const path = page.path;
  const foot = path.foot.map(unpack);
  const gap = path.gap.map(unpack);
  const hair = unpack(path.hairs), outliers = unpack(path.outliers);
  const place = document.getElementById("path");
  const choice = document.getElementById("magnification");

  function magnify(factor) {
    const change = {};
    ["x", "y", "z"].slice(0, foot.length).forEach((axis, i) => {
      const shown = Array.from(foot[i], (f, k) => f + factor * gap[i][k]);
      const hairs = [];
      for (const k of hair) hairs.push(foot[i][k], shown[k], NaN);
      change[axis] = [hairs, shown, Array.from(outliers, (k) => shown[k])];
    });
    Plotly.restyle(place, change, outliers.length ? [1, 3, 4] : [1, 3]);
    for (const e of document.querySelectorAll("[data-magnification]")) {
      e.textContent = factor.toLocaleString("en");
    }
  }

  choice.addEventListener("change", () => magnify(Number(choice.value)));
  for (const [id, way] of [["less", -1], ["more", 1]]) {
    document.getElementById(id).addEventListener("click", () => {
      const next = choice.selectedIndex + way;
      if (next < 0 || next >= choice.options.length) return;
      choice.selectedIndex = next;
      magnify(Number(choice.value));
    });
  }
});
