// The 3D view of a page: turns a body before and with a garment. Needs THREE, THREE.GLTFLoader and THREE.OrbitControls (Debian's libjs-three) and,
// in the page, the elements that it looks up by id. Asks no server for anything. Where there is no WebGL the page keeps its pictures.
(function () {
  "use strict";
  var element = function (id) { return document.getElementById(id); };
  var canvas = element("canvas"), facts = JSON.parse(element("facts").textContent);

  var renderer;
  try {
    renderer = new THREE.WebGLRenderer({canvas: canvas, antialias: true, alpha: true});
  } catch (error) {
    return;  // the pictures stay
  }
  document.body.classList.add("turns");
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));

  var camera = new THREE.PerspectiveCamera(28, 1, 0.05, 20);
  var controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;  // the keys below turn, OrbitControls' own pan
  controls.minDistance = 0.4;
  controls.maxDistance = 6;
  var scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8d8079, 0.75));
  var lamp = new THREE.DirectionalLight(0xffffff, 0.45);
  camera.add(lamp);
  lamp.position.set(0.6, 0.8, 1);
  scene.add(camera);

  var kSkin = new THREE.Color(0.86, 0.74, 0.67), neutral = new THREE.Color().fromArray(facts.neutral);
  var bodies = [];  // before; with the garment as far as the slider says
  var lines = [];   // the same two
  var has_beside = false;  // something else than the body before
  var loop = null, picked = null, share = 1, from = "front", close = true;

  // Linear light as the screen wants it (glTF's colours are linear).
  function displayed(colours) {
    if (!colours) return null;
    var full = colours.normalized ? Math.pow(2, 8 * colours.array.BYTES_PER_ELEMENT) - 1 : 1;
    var shown = new THREE.BufferAttribute(new Float32Array(3 * colours.count), 3);
    for (var i = 0; i < colours.count; ++i)
      shown.setXYZ(i, Math.pow(colours.getX(i) / full, 1 / 2.2), Math.pow(colours.getY(i) / full, 1 / 2.2),
                   Math.pow(colours.getZ(i) / full, 1 / 2.2));
    return shown;
  }

  // Where each vertex is at a share of the way from before to under the garment.
  function blended(mesh) {
    var from = mesh.geometry.attributes.position.array, to = from;
    var morph = mesh.geometry.morphAttributes.position;
    if (morph && morph.length) {
      to = morph[0].array;
      if (mesh.geometry.morphTargetsRelative) to = to.map(function (value, i) { return value + from[i]; });
    }
    var shape = new THREE.BufferGeometry();
    shape.setIndex(mesh.geometry.index);
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(from), 3));
    return {
      shape: shape,
      colours: displayed(mesh.geometry.attributes.color),
      values: mesh.geometry.attributes[facts.reading.attribute],
      show: function (t) {
        var now = shape.attributes.position;
        for (var i = 0; i < now.array.length; ++i) now.array[i] = from[i] + t * (to[i] - from[i]);
        now.needsUpdate = true;
        shape.computeVertexNormals();
        shape.computeBoundingSphere();
      }
    };
  }

  function paint(body, t) {
    var coloured = element("colours").checked, shown = coloured ? t : 0, source = body.colours;
    var plain = coloured ? neutral : kSkin;
    if (!source) return;
    var to = body.shape.attributes.color;
    if (!to) {
      to = new THREE.BufferAttribute(new Float32Array(3 * source.count), 3);
      body.shape.setAttribute("color", to);
    }
    for (var i = 0; i < source.count; ++i)
      to.setXYZ(i, plain.r + shown * (source.getX(i) - plain.r), plain.g + shown * (source.getY(i) - plain.g),
                plain.b + shown * (source.getZ(i) - plain.b));
    to.needsUpdate = true;
  }

  function add(mesh) {
    var is_body = mesh.name === "body" || mesh.name === "beside";
    [0, 1].forEach(function (which) {
      if (is_body && has_beside && which !== (mesh.name === "beside" ? 0 : 1)) return;
      var made = blended(mesh);
      made.mesh = new THREE.Mesh(made.shape, is_body ?
          new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide}) :
          new THREE.MeshLambertMaterial({color: 0x3b2f2a}));
      made.which = which;
      scene.add(made.mesh);
      (is_body ? bodies : lines).push(made);
      made.show(which);
      if (!made.colours && is_body) made.mesh.material = new THREE.MeshLambertMaterial({color: kSkin, side: THREE.DoubleSide});
      if (is_body) paint(made, which);
    });
  }

  function tube(points) {
    var curve = new THREE.CatmullRomCurve3(points.map(function (p) { return new THREE.Vector3(p[0], p[1], p[2]); }), true);
    return new THREE.TubeGeometry(curve, 2 * points.length, 0.0035, 6, true);
  }

  function draw_loop(t) {
    if (loop) { scene.remove(loop); loop.geometry.dispose(); loop = null; }
    var chosen = picked && facts.loops[picked];
    if (!chosen) return;
    loop = new THREE.Mesh(tube(chosen.before.map(function (p, i) {
      return p.map(function (value, k) { return value + t * (chosen.after[i][k] - value); });
    })), new THREE.MeshLambertMaterial({color: 0x1f5fbf}));
    scene.add(loop);
  }

  function render() {
    var width = canvas.clientWidth, height = canvas.clientHeight, halves = element("beside").checked ? 2 : 1;
    renderer.setSize(width, height, false);
    camera.aspect = width / halves / height;
    camera.updateProjectionMatrix();
    renderer.setScissorTest(true);
    for (var half = 0; half < halves; ++half) {
      var only = halves === 2 ? half : 1;
      bodies.forEach(function (b) { b.mesh.visible = b.which === only; });
      lines.forEach(function (l) { l.mesh.visible = l.which === only && element("lines").checked; });
      if (loop) draw_loop(halves === 2 && half === 0 ? 0 : share);
      renderer.setViewport(half * width / halves, 0, width / halves, height);
      renderer.setScissor(half * width / halves, 0, width / halves, height);
      renderer.render(scene, camera);
    }
    if (!canvas.dataset.drawn) canvas.dataset.drawn = Math.round(performance.now());
  }

  function change() {
    share = element("share").valueAsNumber / 100;
    bodies.concat(lines).forEach(function (made) { if (made.which === 1) made.show(share); });
    bodies.forEach(function (body) { paint(body, body.which === 1 ? share : 0); });
    draw_loop(share);
    element("share").setAttribute("aria-valuetext", Math.round(100 * share) + " % of the way to the garment");
    render();
  }

  // Her whole body, or the part of it that the garment's lines are on.
  function frame() {
    var box = new THREE.Box3();
    if (close) lines.forEach(function (line) { box.expandByObject(line.mesh); });
    if (!box.isEmpty()) return box.expandByScalar(0.12);
    return box.setFromObject(bodies[0].mesh);
  }

  function look() {
    var box = frame(), centre = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
    var wide = (from === "front" || from === "back" ? size.x : size.z) / Math.max(camera.aspect, 0.01);
    var deep = from === "front" || from === "back" ? size.z : size.x;
    var away = 0.53 * Math.max(size.y, wide) / Math.tan(camera.fov * Math.PI / 360) + deep / 2;
    var angle = {front: 0, left: 90, back: 180, right: 270}[from] * Math.PI / 180;
    controls.target.copy(centre);
    camera.position.set(centre.x + away * Math.sin(angle), centre.y, centre.z + away * Math.cos(angle));
    controls.maxDistance = 2 * away;
    controls.update();
    render();
  }

  function turn(by, up) {
    var about = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    about.theta += by;
    about.phi = Math.min(Math.max(about.phi - up, 0.2), Math.PI - 0.2);
    camera.position.setFromSpherical(about).add(controls.target);
    controls.update();
    render();
  }

  function nearer(by) {
    camera.position.sub(controls.target).multiplyScalar(by).add(controls.target);
    controls.update();
    render();
  }

  // What is under the finger: how much the skin is pressed together or stretched there.
  function read(event) {
    var box = canvas.getBoundingClientRect(), halves = element("beside").checked ? 2 : 1;
    var x = (event.clientX - box.left) / box.width * halves, half = Math.min(Math.floor(x), halves - 1);
    var ray = new THREE.Raycaster();
    ray.setFromCamera({x: 2 * (x - half) - 1, y: 1 - 2 * (event.clientY - box.top) / box.height}, camera);
    var t = halves === 2 && half === 0 ? 0 : share, body = bodies.find(function (b) { return b.which === (halves === 2 ? half : 1); });
    body.mesh.visible = true;
    var hit = ray.intersectObject(body.mesh)[0];
    element("reading").textContent = !hit || !body.values ? "" : words_of(t, body.values.getX(hit.face.a));
  }

  function words_of(t, value) {
    var said = facts.reading;
    if (!said.per_cent && t < 1) return "";  // a distance is one of the body with the garment
    if (!said.per_cent && value >= said.none_from) return said.here + said.none;
    var shown = said.per_cent ? Math.round(100 * t * (value - 1)) : Math.round(10000 * value) / 10;
    if (shown === 0) return said.here + said.same;
    return said.here + Math.abs(shown) + (said.per_cent ? " % " : " mm ") + (shown < 0 ? said.low : said.high);
  }

  function pick(row) {
    var name = row.dataset.loop;
    picked = picked === name ? null : name;
    document.querySelectorAll("[data-loop]").forEach(function (r) { r.setAttribute("aria-pressed", r.dataset.loop === picked); });
    draw_loop(share);
    render();
  }

  function begin(model) {
    var meshes = [];
    model.scene.updateMatrixWorld(true);
    model.scene.traverse(function (node) { if (node.isMesh) meshes.push(node); });
    has_beside = meshes.some(function (mesh) { return mesh.name === "beside"; });
    meshes.forEach(add);
    controls.addEventListener("change", render);
    ["share", "colours"].forEach(function (id) { element(id).addEventListener("input", change); });
    ["lines", "beside"].forEach(function (id) { element(id).addEventListener("input", render); });
    document.querySelectorAll("[data-look]").forEach(function (button) {
      button.addEventListener("click", function () { from = button.dataset.look; look(); });
    });
    element("close").addEventListener("input", function () { close = element("close").checked; look(); });
    document.querySelectorAll("[data-loop]").forEach(function (row) {
      row.disabled = false;
      row.addEventListener("click", function () { pick(row); });
    });
    canvas.addEventListener("pointermove", read);
    canvas.addEventListener("pointerdown", read);
    canvas.addEventListener("keydown", function (event) {
      var act = {ArrowLeft: function () { turn(-0.1, 0); }, ArrowRight: function () { turn(0.1, 0); },
                 ArrowUp: function () { turn(0, 0.1); }, ArrowDown: function () { turn(0, -0.1); },
                 "+": function () { nearer(0.9); }, "-": function () { nearer(1.1); }}[event.key];
      if (!act) return;
      act();
      event.preventDefault();
    });
    window.addEventListener("resize", render);
    if (!lines.length)
      ["lines", "close"].forEach(function (id) { element(id).parentElement.hidden = true; });
    take_from_address();
    change();
    look();
  }

  // fit.html#share=50&look=left&beside=1&colours=0&lines=0&close=0&loop=bust opens that view.
  function take_from_address() {
    new URLSearchParams(window.location.hash.slice(1)).forEach(function (value, name) {
      if (name === "share") element("share").value = value;
      else if (name === "look" && document.querySelector("[data-look=" + CSS.escape(value) + "]")) from = value;
      else if (name === "loop" && facts.loops[value]) pick(document.querySelector("[data-loop=" + CSS.escape(value) + "]"));
      else if (["colours", "lines", "beside", "close"].indexOf(name) >= 0) element(name).checked = value === "1";
    });
    close = element("close").checked;
  }

  var packed = atob(element("glb").textContent.trim()), bytes = new Uint8Array(packed.length);
  for (var i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  new THREE.GLTFLoader().parse(bytes.buffer, "", begin, function () { document.body.classList.remove("turns"); });
}());
