(() => {
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
    const key = (row, column) => {
      const data = row.cells[column].querySelector("data");
      const value = data ? data.value : row.cells[column].textContent.trim();
      return value === "null" ? null : data && value !== "" && !Number.isNaN(Number(value)) ? Number(value) : value;
    };
    heads.forEach((head, column) => {
      head.querySelector("button")?.addEventListener("click", () => {
        const up = head.getAttribute("aria-sort") !== "ascending";
        for (const other of heads) if (other.hasAttribute("aria-sort")) other.setAttribute("aria-sort", "none");
        head.setAttribute("aria-sort", up ? "ascending" : "descending");
        const rows = [...body.rows].sort((one, two) => {
          const [a, b] = [key(one, column), key(two, column)];
          // What was not measured comes last in either order.
          if (a === null || b === null) return (a === null) - (b === null);
          const order = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
          return up ? order : -order;
        });
        body.append(...rows);
      });
    });
  }
})();
