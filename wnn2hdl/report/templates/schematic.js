(() => {
  for (const bench of document.querySelectorAll(".bench")) {
    const panel = bench.querySelector(".inspector"), cells = [...bench.querySelectorAll(".schematic .cell")];
    const wires = [...bench.querySelectorAll(".wire")];
    const show = (cell) => {
      if (cell.getAttribute("aria-pressed") === "true") return;
      for (const other of cells) other.setAttribute("aria-pressed", String(other === cell));
      for (const wire of wires) wire.classList.toggle("lit", [wire.dataset.from, wire.dataset.to].includes(cell.dataset.name));
      const card = document.getElementById(cell.getAttribute("aria-controls")).cloneNode(true);
      card.removeAttribute("id");
      panel.replaceChildren(card);
    };
    for (const cell of cells) {
      for (const event of ["mouseenter", "focus", "click"]) cell.addEventListener(event, () => show(cell));
      cell.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (event.key === "Enter" || event.key === " ") show(cell);
        else if (step) cells[(cells.indexOf(cell) + step + cells.length) % cells.length].focus();
        else return;
        event.preventDefault();
      });
    }
    if (cells.length) show(cells[0]);
  }
  addEventListener("beforeprint", () => { for (const part of document.querySelectorAll("details")) part.open = true; });
})();
