// Plays the frames of a run on a canvas. The numbers stand in a JSON element (figures/animation.py tells how).
(function () {
  "use strict";
  var root = document.getElementById("animation");
  if (!root) return;
  var film = JSON.parse(document.getElementById("animation-data").textContent);
  var text = atob(film.data), bytes = new Uint8Array(text.length);
  for (var i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  film.data = null;
  function array(name) {
    var w = film.where[name], size = w[0] === "u2" ? 2 : 1, part = bytes.buffer.slice(w[1], w[1] + w[2] * size);
    return size === 2 ? new Uint16Array(part) : new Uint8Array(part);
  }
  var corners = array("corners"), raw = array("outline"), generation = array("generation"), boundary = array("boundary");
  var outline = new Float32Array(raw.length), begin = new Uint32Array(corners.length + 1);
  for (i = 0; i < raw.length; i++) outline[i] = (raw[i] / 32767.5 - 1) * film.reach / film.side;
  for (i = 0; i < corners.length; i++) begin[i + 1] = begin[i] + corners[i];
  var frames = film.strain.map(function (_, k) {
    return {who: array("who" + k), at: array("at" + k), turn: array("turn" + k), moved: array("moved" + k),
            pair: array("pair" + k), force: array("force" + k)};
  });

  var canvas = root.querySelector("canvas"), pen = canvas.getContext("2d");
  var slider = root.querySelector("input[type=range]"), button = root.querySelector("button");
  var said = root.querySelector("output"), colours = root.querySelector("select");
  var chains = root.querySelector("input[type=checkbox]"), legends = root.querySelectorAll("[data-legend]");
  var generations = JSON.parse(root.dataset.generations), shades = JSON.parse(root.dataset.shades);
  var calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  var now = frames.length - 1, timer = null;

  function fit() {
    var width = canvas.clientWidth, ratio = Math.max(window.devicePixelRatio || 1, 1.5);
    canvas.style.height = Math.round(width * film.aspect * 1.01) + "px";
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(canvas.width * film.aspect * 1.01);
    draw();
  }
  function colour(frame, row) {
    if (colours.value === "displacement")
      return Math.min(shades.length - 1, Math.floor(frame.moved[row] / 256 * shades.length));
    var particle = frame.who[row];
    return boundary[particle] ? generations.length : Math.min(generation[particle], generations.length - 1);
  }
  function draw() {
    var frame = frames[now], scale = canvas.width, up = 0.5 * (canvas.width + canvas.height), count = frame.who.length;
    var byDisplacement = colours.value === "displacement";
    var palette = byDisplacement ? shades : generations.concat(["#cdd4da"]);
    var paths = palette.map(function () { return new Path2D(); });
    var x = new Float32Array(count), y = new Float32Array(count);
    for (var row = 0; row < count; row++) {
      var particle = frame.who[row], angle = frame.turn[row] / 65536 * 2 * Math.PI;
      var c = Math.cos(angle), s = Math.sin(angle), path = paths[colour(frame, row)];
      x[row] = frame.at[2 * row] / 65535 * scale;
      y[row] = up - frame.at[2 * row + 1] / 65535 * scale;
      for (var v = begin[particle]; v < begin[particle + 1]; v++) {
        var px = outline[2 * v] * scale, py = outline[2 * v + 1] * scale;
        var wx = x[row] + c * px - s * py, wy = y[row] - s * px - c * py;
        if (v === begin[particle]) path.moveTo(wx, wy); else path.lineTo(wx, wy);
      }
      path.closePath();
    }
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.lineJoin = pen.lineCap = "round";
    pen.lineWidth = scale * 0.0008;
    pen.strokeStyle = "#ffffff";
    palette.forEach(function (shade, k) { pen.fillStyle = shade; pen.fill(paths[k]); pen.stroke(paths[k]); });
    if (chains.checked) {
      var widths = 12, lines = [];
      for (var k = 0; k < widths; k++) lines.push(new Path2D());
      for (var n = 0; n < frame.force.length; n++) {
        var line = lines[Math.min(widths - 1, Math.floor(frame.force[n] * widths / 120))];
        line.moveTo(x[frame.pair[2 * n]], y[frame.pair[2 * n]]);
        line.lineTo(x[frame.pair[2 * n + 1]], y[frame.pair[2 * n + 1]]);
      }
      pen.strokeStyle = "rgba(31, 41, 51, 0.85)";
      lines.forEach(function (path, k) { pen.lineWidth = scale * 0.0095 * (k + 0.5) / widths; pen.stroke(path); });
    }
    var words = "axial strain " + (100 * film.strain[now]).toFixed(1) + " %";
    said.textContent = words + " · " + film.particles[now] + " particles" +
      (film.fragments[now] ? " · " + film.fragments[now] + " fragments" : "") + " · " + film.contacts[now] + " contacts";
    slider.value = now;
    slider.setAttribute("aria-valuetext", words);
    canvas.setAttribute("aria-label", "The assembly at " + said.textContent.replace(/ · /g, ", "));
    canvas.dataset.frame = now;
    for (k = 0; k < legends.length; k++) legends[k].hidden = legends[k].dataset.legend !== colours.value;
  }
  function stop() {
    if (timer) window.clearInterval(timer);
    timer = null;
    button.textContent = "▶ Play";
    button.setAttribute("aria-label", "Play the animation");
  }
  function play() {
    if (now === frames.length - 1) now = 0;
    button.textContent = "❚❚ Pause";
    button.setAttribute("aria-label", "Pause the animation");
    draw();
    timer = window.setInterval(function () {
      now += 1;
      draw();
      if (now === frames.length - 1) stop();
    }, calm.matches ? 1000 : 110);
  }
  button.addEventListener("click", function () { if (timer) stop(); else play(); });
  slider.max = now;
  slider.addEventListener("input", function () { stop(); now = Number(slider.value); draw(); });
  colours.addEventListener("change", draw);
  chains.addEventListener("change", draw);
  canvas.addEventListener("keydown", function (event) {
    var step = {ArrowRight: 1, ArrowLeft: -1, Home: -frames.length, End: frames.length}[event.key];
    if (event.key === " ") { button.click(); } else if (step) {
      stop();
      now = Math.max(0, Math.min(frames.length - 1, now + step));
      draw();
    } else return;
    event.preventDefault();
  });
  window.addEventListener("resize", fit);
  window.addEventListener("beforeprint", stop);
  stop();
  fit();
})();
