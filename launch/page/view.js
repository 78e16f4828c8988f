// The 3D view of a page: turns a body before and with a garment. Needs THREE and THREE.OrbitControls (Debian's libjs-three) and, in the page,
// the elements that it looks up by id. Asks no server for anything. Where there is no WebGL the page keeps its pictures.
(function () {
  "use strict";
  var element = function (id) { return document.getElementById(id); };
  var canvas = element("canvas"), facts = JSON.parse(element("facts").textContent);

  if (!canvas.drawn_by) return;  // the pictures stay
  var renderer = new THREE.WebGLRenderer({canvas: canvas, context: canvas.drawn_by});
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

  // The meshes of a GLB as this package writes it: one primitive each, tight accessors, no transforms. At once, where a general loader
  // would wait until the rest of the page is drawn.
  function meshes_of(buffer) {
    var head = new DataView(buffer), length = head.getUint32(12, true), data = 20 + length + 8;
    var gltf = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
    var types = {5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array}, widths = {SCALAR: 1, VEC3: 3, VEC4: 4};
    function numbers(index) {
      var accessor = gltf.accessors[index], view = gltf.bufferViews[accessor.bufferView];
      return new types[accessor.componentType](buffer, data + view.byteOffset, accessor.count * widths[accessor.type]);
    }
    return gltf.meshes.map(function (mesh) {
      var part = mesh.primitives[0], has = part.attributes, values = has[facts.reading.attribute];
      return {name: mesh.name, triangles: numbers(part.indices), from: numbers(has.POSITION),
              offset: part.targets ? numbers(part.targets[0].POSITION) : null,
              colours: has.COLOR_0 === undefined ? null : displayed(numbers(has.COLOR_0)),
              values: values === undefined ? null : numbers(values)};
    });
  }

  // RGBA of 16 bits of linear light as RGB that the screen wants.
  function displayed(colours) {
    var shown = new Float32Array(colours.length / 4 * 3);
    for (var i = 0; i < shown.length; ++i) shown[i] = Math.pow(colours[4 * Math.floor(i / 3) + i % 3] / 65535, 1 / 2.2);
    return shown;
  }

  // Area-weighted normals per vertex, not of length 1: the shader makes them so.
  function find_normals(points, triangles, normals) {
    normals.fill(0);
    for (var t = 0; t < triangles.length; t += 3) {
      var a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      var ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
      var vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
      var x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      normals[a] += x; normals[a + 1] += y; normals[a + 2] += z;
      normals[b] += x; normals[b + 1] += y; normals[b + 2] += z;
      normals[c] += x; normals[c + 1] += y; normals[c + 2] += z;
    }
  }

  // Where each vertex is at a share of the way from before to under the garment.
  function blended(mesh) {
    var from = mesh.from, offset = mesh.offset, count = from.length;
    var shape = new THREE.BufferGeometry();
    shape.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(from), 3));
    shape.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(count), 3));
    return {
      shape: shape,
      colours: mesh.colours,
      values: mesh.values,
      shown: null,
      show: function (t) {
        if (this.shown === t) return;
        this.shown = t;
        var now = shape.attributes.position, normals = shape.attributes.normal;
        for (var i = 0; offset && i < count; ++i) now.array[i] = from[i] + t * offset[i];
        find_normals(now.array, mesh.triangles, normals.array);
        now.needsUpdate = normals.needsUpdate = true;
        shape.computeBoundingSphere();
      }
    };
  }

  // 0 of the body before, else the slider's.
  function share_of(made) { return made.which === 1 ? share : 0; }

  function paint(body, t) {
    var coloured = element("colours").checked, shown = coloured ? t : 0, source = body.colours;
    var plain = coloured ? neutral : kSkin, painted = coloured + " " + t;
    if (!source || body.painted === painted) return;
    body.painted = painted;
    var to = body.shape.attributes.color, base = plain.toArray();
    if (!to) {
      to = new THREE.BufferAttribute(new Float32Array(source.length), 3);
      body.shape.setAttribute("color", to);
    }
    for (var i = 0; i < source.length; ++i) to.array[i] = base[i % 3] + shown * (source[i] - base[i % 3]);
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
      if (!made.colours && is_body) made.mesh.material = new THREE.MeshLambertMaterial({color: kSkin, side: THREE.DoubleSide});
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

  function fit_canvas() {
    var width = canvas.clientWidth, height = canvas.clientHeight, halves = element("beside").checked ? 2 : 1;
    renderer.setSize(width, height, false);
    camera.aspect = width / halves / height;
    camera.updateProjectionMatrix();
    return {width: width, height: height, halves: halves};
  }

  function render() {
    var size = fit_canvas(), width = size.width, height = size.height, halves = size.halves;
    renderer.setScissorTest(true);
    for (var half = 0; half < halves; ++half) {
      var only = halves === 2 ? half : 1;
      bodies.forEach(function (b) { b.mesh.visible = b.which === only; });
      lines.forEach(function (l) { l.mesh.visible = l.which === only && element("lines").checked; });
      bodies.concat(lines).forEach(function (made) {
        if (!made.mesh.visible) return;
        made.show(share_of(made));
        paint(made, share_of(made));
      });
      if (loop) draw_loop(halves === 2 && half === 0 ? 0 : share);
      renderer.setViewport(half * width / halves, 0, width / halves, height);
      renderer.setScissor(half * width / halves, 0, width / halves, height);
      renderer.render(scene, camera);
    }
    if (!canvas.dataset.drawn) canvas.dataset.drawn = Math.round(performance.now());
  }

  function take_share() {
    share = element("share").valueAsNumber / 100;
    element("share").setAttribute("aria-valuetext", Math.round(100 * share) + " % of the way to the garment");
  }

  function change() {
    take_share();
    render();
  }

  // Her whole body, or the part of it that the garment's lines are on.
  function frame() {
    var box = new THREE.Box3();
    if (close) lines.forEach(function (line) { line.show(share_of(line)); box.expandByObject(line.mesh); });
    if (!box.isEmpty()) return box.expandByScalar(0.12);
    return box.setFromObject(bodies[0].mesh);
  }

  function look() {
    fit_canvas();
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
  }

  function nearer(by) {
    camera.position.sub(controls.target).multiplyScalar(by).add(controls.target);
    controls.update();
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
    element("reading").textContent = !hit || !body.values ? "" : words_of(t, body.values[hit.face.a]);
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

  function begin(meshes) {
    has_beside = meshes.some(function (mesh) { return mesh.name === "beside"; });
    meshes.forEach(add);
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
    canvas.addEventListener("webglcontextrestored", render);  // phones take it from pages in the background
    if (!lines.length)
      ["lines", "close"].forEach(function (id) { element(id).parentElement.hidden = true; });
    take_from_address();
    take_share();
    look();
    controls.addEventListener("change", render);  // not before: the first picture is drawn once
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
  begin(meshes_of(bytes.buffer));
}());
