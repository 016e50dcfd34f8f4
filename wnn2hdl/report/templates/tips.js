(() => {
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.setAttribute("role", "status");
  let shown = null;
  const hide = () => { shown?.classList.remove("shown"); shown = null; tip.remove(); };
  const show = (mark) => {
    if (mark === shown) return;
    hide();
    shown = mark;
    mark.classList.add("shown");
    tip.textContent = mark.dataset.tip;
    document.body.append(tip);
    const box = mark.getBoundingClientRect(), own = tip.getBoundingClientRect();
    const left = Math.min(Math.max(box.left + box.width / 2 - own.width / 2, 4), document.documentElement.clientWidth - own.width - 4);
    const top = box.top - own.height - 6;
    tip.style.left = `${left + scrollX}px`;
    tip.style.top = `${(top < 4 ? box.bottom + 6 : top) + scrollY}px`;
  };
  for (const drawing of document.querySelectorAll("svg:has(.mark)")) {
    const marks = [...drawing.querySelectorAll(".mark")];
    for (const mark of marks) {
      // Without a script the browser shows these titles, later and smaller.
      const title = mark.querySelector("title");
      mark.dataset.tip = title.textContent;
      title.remove();
      mark.addEventListener("pointerenter", () => show(mark));
      mark.addEventListener("pointerleave", hide);
    }
    drawing.tabIndex = 0;
    drawing.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (event.key === "Escape") hide();
      if (!step) return;
      const at = marks.indexOf(shown);
      show(marks[at < 0 ? (step > 0 ? 0 : marks.length - 1) : (at + step + marks.length) % marks.length]);
      event.preventDefault();
    });
    drawing.addEventListener("blur", hide);
  }
})();
