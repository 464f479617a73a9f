(function () {
  "use strict";
  var all = function (selector, root) { return Array.from((root || document).querySelectorAll(selector)); };
  document.documentElement.classList.add("js");

  // Contents: closed on a narrow screen, with the chapter that is being read marked.
  var menu = document.querySelector("nav details");
  if (window.matchMedia("(max-width: 62rem)").matches) { menu.open = false; }
  menu.addEventListener("click", function (event) {
    if (event.target.tagName === "A" && window.matchMedia("(max-width: 62rem)").matches) { menu.open = false; }
  });
  var links = new Map(all("nav a").map(function (link) { return [link.hash.slice(1), link]; }));
  var watcher = new IntersectionObserver(function (entries) {
    entries.forEach(function (entry) {
      if (!entry.isIntersecting) { return; }
      links.forEach(function (link, id) { link.classList.toggle("here", id === entry.target.id); });
    });
  }, { rootMargin: "0px 0px -75% 0px" });
  links.forEach(function (link, id) { var target = document.getElementById(id); if (target) { watcher.observe(target); } });

  // A link to something that is folded unfolds it.
  function unfold() {
    var target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (var one = target; one; one = one.parentElement) { if (one.tagName === "DETAILS") { one.open = true; } }
    if (target) { target.scrollIntoView(); }
  }
  window.addEventListener("hashchange", unfold);
  if (location.hash) { unfold(); }
  window.addEventListener("beforeprint", function () { all("details").forEach(function (one) { one.open = true; }); });

  // Filter: rows and cases that hold all words and one of the verdicts chosen.
  var box = document.querySelector(".filter input"), chips = all(".filter button"), told = document.querySelector(".filter output");
  var rows = all("[data-verdict]"), texts = rows.map(function (row) { return row.textContent.toLowerCase(); });
  function filter() {
    var words = box.value.toLowerCase().split(/\s+/).filter(Boolean), shown = 0, total = 0;
    var chosen = chips.filter(function (chip) { return chip.getAttribute("aria-pressed") === "true"; }).map(function (chip) { return chip.value; });
    rows.forEach(function (row, k) {
      var has = words.every(function (word) { return texts[k].includes(word); }) &&
        (!chosen.length || row.dataset.verdict.split("|").some(function (verdict) { return chosen.includes(verdict); }));
      row.hidden = !has;
      if (row.tagName === "TR") { total += 1; shown += has ? 1 : 0; }
    });
    all("section.chapter").forEach(function (chapter) { chapter.hidden = all("[data-verdict]", chapter).every(function (row) { return row.hidden; }); });
    told.textContent = words.length || chosen.length ? shown + " of " + total + " rows" : "";
  }
  box.addEventListener("input", filter);
  chips.forEach(function (chip) {
    chip.addEventListener("click", function () { chip.setAttribute("aria-pressed", chip.getAttribute("aria-pressed") !== "true"); filter(); });
  });

  // Sorting by a click on a head: numbers as numbers, by data-sort where it stands.
  function value(row, column) {
    var cell = row.cells[column] || row.cells[row.cells.length - 1], text = cell.dataset.sort || cell.textContent.trim(), number = parseFloat(text);
    return { text: text, number: isNaN(number) ? Infinity : number };
  }
  function sort(head) {
    var table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex;
    var sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    all("th", table).forEach(function (other) { other.removeAttribute("aria-sort"); });
    head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    Array.from(body.rows).sort(function (one, other) {
      var a = value(one, column), b = value(other, column);
      if (a.number === b.number) { return sign * a.text.localeCompare(b.text); }
      return sign * (a.number < b.number ? -1 : 1);
    }).forEach(function (row) { body.appendChild(row); });
  }
  all(".sortable thead th").forEach(function (head) {
    head.tabIndex = 0;
    head.addEventListener("click", function () { sort(head); });
    head.addEventListener("keydown", function (event) { if (event.key === "Enter") { sort(head); } });
  });

  // Data: of a figure unpacked when asked for, of a table from its cells.
  function save(blob, name) {
    var link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
  }
  all("a.csv").forEach(function (link) {
    link.hidden = false;
    link.href = "#" + (link.closest("[id]") || document.body).id;
    link.addEventListener("click", function (event) {
      event.preventDefault();
      var bytes = Uint8Array.from(atob(link.dataset.gzip), function (letter) { return letter.charCodeAt(0); });
      new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).blob().then(function (blob) { save(blob, link.download); });
    });
  });
  all("table.sortable, .wide table, .matrix").forEach(function (table) {
    var button = document.createElement("button");
    button.className = "data";
    button.textContent = "table as CSV";
    button.addEventListener("click", function () {
      var lines = Array.from(table.rows).map(function (row) {
        return Array.from(row.cells).map(function (cell) { return '"' + cell.textContent.trim().replace(/\s+/g, " ").replace(/"/g, '""') + '"'; }).join(",");
      });
      save(new Blob([lines.join("\n") + "\n"], { type: "text/csv" }), "table.csv");
    });
    table.after(button);
  });
})();
