// Sorts a table by the heading that is clicked, and hides the rows without the words that are typed.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0], field = document.createElement("input");
  field.type = "search"; field.className = "filter"; field.placeholder = "show rows with …";
  field.setAttribute("aria-label", "show only rows with these words");
  const count = document.createElement("output");
  const shown = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let left = 0;
    for (const row of body.rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      left += !row.hidden;
    }
    count.textContent = words.length ? `${left} of ${body.rows.length}` : "";
  };
  field.addEventListener("input", shown);
  const bar = document.createElement("p");
  bar.className = "quiet tools"; bar.append(field, " ", count);
  table.parentElement.before(bar);
  const value = (row, column) => {
    const text = row.cells[column].textContent.trim(), number = parseFloat(text);
    return text === "" || text === "-" ? null : Number.isNaN(number) ? text.toLowerCase() : number;
  };
  const order = (a, b) => typeof a === typeof b ? (a < b ? -1 : a > b ? 1 : 0) : typeof a === "number" ? -1 : 1;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    if (!head.textContent.trim()) return;
    const button = document.createElement("span");  // with a real button in it no head is printed on later pages
    button.role = "button"; button.tabIndex = 0; button.className = "sort";
    button.append(...head.childNodes); head.append(button);
    button.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") { event.preventDefault(); button.click(); }
    });
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const rows = [...body.rows].map((row, place) => [value(row, column), place, row]);
      rows.sort(([a, i], [b, k]) => {
        if (a === null || b === null) return (a === null) - (b === null) || i - k;
        return (down ? order(b, a) : order(a, b)) || i - k;
      });
      body.append(...rows.map(([, , row]) => row));
    });
  });
}
