// Saves a figure as it stands on the page, and gives every table that has no link of its own one to its cells as CSV.
(function () {
  "use strict";
  document.addEventListener("click", function (event) {
    var name = event.target.dataset && event.target.dataset.svg;
    if (!name) return;
    var drawing = document.getElementById(name).querySelector("svg");
    var text = '<?xml version="1.0" encoding="utf-8"?>\n' + new XMLSerializer().serializeToString(drawing);
    var link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], {type: "image/svg+xml"}));
    link.download = name + ".svg";
    link.click();
    window.setTimeout(function () { URL.revokeObjectURL(link.href); }, 1000);
  });
  function cell(one) {
    var text = one.textContent.trim().replace(/\s+/g, " ");
    return /[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
  }
  document.querySelectorAll(".card > table").forEach(function (table, k) {
    if (table.parentElement.querySelector(".links")) return;
    var text = Array.from(table.rows).map(function (row) { return Array.from(row.cells).map(cell).join(","); });
    var line = document.createElement("p"), link = document.createElement("a");
    line.className = "links";
    link.download = "table_" + (k + 1) + ".csv";
    link.href = URL.createObjectURL(new Blob([text.join("\n") + "\n"], {type: "text/csv"}));
    link.textContent = "Table (CSV)";
    line.appendChild(link);
    table.parentElement.appendChild(line);
  });
})();
