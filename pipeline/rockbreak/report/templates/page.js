// Saves a figure as it stands on the page.
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
