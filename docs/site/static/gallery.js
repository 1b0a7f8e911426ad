// Cards of the gallery are shown if they fit all choices.
document.addEventListener("DOMContentLoaded", () => {
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
