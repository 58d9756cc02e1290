// Shows the pose that a name like A@188 stands for, while it is pointed at or has the focus.
"use strict";

(() => {
  const GAP = 8; // pixels between a name and its picture
  const card = document.createElement("div"), picture = document.createElement("i"), words = document.createElement("span");
  card.hidden = true;
  card.setAttribute("role", "tooltip");
  card.append(picture, words);
  document.body.append(card);

  const hide = () => (card.hidden = true);

  function show(name) {
    const place = name.getBoundingClientRect();
    card.className = `pose-card ${[...name.classList].find((each) => each.startsWith("pose-"))}`;
    words.textContent = `${name.textContent}: ${name.dataset.words}`;
    card.hidden = false;
    const right = document.documentElement.clientWidth - card.offsetWidth - GAP;
    const below = place.bottom + GAP + card.offsetHeight < innerHeight;
    card.style.left = `${Math.max(GAP, Math.min(place.left, right))}px`;
    card.style.top = `${below ? place.bottom + GAP : Math.max(GAP, place.top - GAP - card.offsetHeight)}px`;
  }

  for (const event of ["pointerover", "focusin"])
    document.addEventListener(event, ({ target }) => {
      const name = target.closest?.(".pose");
      if (name) show(name);
    });
  for (const event of ["pointerout", "focusout"])
    document.addEventListener(event, ({ target }) => { if (target.closest?.(".pose")) hide(); });
  document.addEventListener("keydown", ({ key }) => { if (key === "Escape") hide(); });
  addEventListener("scroll", hide, { passive: true, capture: true });
})();
