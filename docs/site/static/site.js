// The gallery's choices, and what the theme leaves open for people who have no mouse.
document.addEventListener("DOMContentLoaded", () => {
  for (const e of document.querySelectorAll("pre, .table-wrapper, .math"))
    if (e.scrollWidth > e.clientWidth) e.tabIndex = 0;
  for (const e of document.querySelectorAll("[role=heading]:not([aria-level])"))
    e.ariaLevel = "2";

  const form = document.getElementById("choices");
  if (!form) return;
  const cards = [...document.querySelectorAll(".cards .card")];
  const told = document.getElementById("shown");
  const show = () => {
    const wanted = [...new FormData(form)].filter(([, value]) => value);
    for (const card of cards)
      card.hidden = !wanted.every(([key, value]) => card.dataset[key].split("|").includes(value));
    told.textContent = `${cards.filter((card) => !card.hidden).length} of ${cards.length}`;
  };
  form.addEventListener("change", show);
  show();
});
