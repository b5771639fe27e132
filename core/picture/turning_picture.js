// The viewer of a picture that turns in a browser: see turning_picture.h. It finds the data in the element
// "picture-data" and needs the global THREE with OrbitControls.
'use strict';
(function () {
  var data = JSON.parse(document.getElementById('picture-data').textContent);
  var state = document.body.dataset;
  window.addEventListener('error', function (e) { state.state = 'failed: ' + e.message; });

  function bytes(text) {
    var raw = atob(text), result = new Uint8Array(raw.length);
    for (var n = 0; n < raw.length; ++n) result[n] = raw.charCodeAt(n);
    return result.buffer;
  }
  function message(text) {
    var p = document.createElement('p');
    p.className = 'message';
    p.textContent = text;
    document.getElementById('view').appendChild(p);
    state.state = 'failed: ' + text;
  }

  var view = document.getElementById('view'), renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (e) {
    message('This browser shows no WebGL, which the turning picture needs.');
    return;
  }
  renderer.setPixelRatio(window.devicePixelRatio || 1);
  renderer.setClearColor(0xffffff);
  view.appendChild(renderer.domElement);

  var scene = new THREE.Scene();
  var camera = new THREE.PerspectiveCamera(35, 1, data.size / 1000, 20 * data.size);
  camera.up.set(0, 0, 1);
  var light = new THREE.DirectionalLight(0xffffff, 0.75);
  light.position.set(-0.35, 0.45, 1);
  camera.add(light);
  scene.add(camera);
  scene.add(new THREE.AmbientLight(0xffffff, 0.45));
  var plane = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);

  // Each side of a surface is a mesh of its own, so that materials go one by one.
  var meshes = [];
  data.parts.forEach(function (part) {
    var geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(bytes(part.points)), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(part.triangles)), 1));
    geometry.computeVertexNormals();
    [[part.front, THREE.FrontSide], [part.back, THREE.BackSide]].forEach(function (side) {
      var material = new THREE.MeshPhongMaterial(
        { color: data.materials[side[0]].colour, side: side[1], shininess: 20, specular: 0x222222 });
      var mesh = new THREE.Mesh(geometry, material);
      mesh.userData.material = side[0];
      scene.add(mesh);
      meshes.push(mesh);
    });
  });
  if (data.box) {
    var min = new THREE.Vector3().fromArray(data.box[0]), max = new THREE.Vector3().fromArray(data.box[1]);
    var box = new THREE.Box3Helper(new THREE.Box3(min, max), 0x888888);
    scene.add(box);
  }

  // What lies in the plane of a cut: one texture, for the layer of points that is nearest.
  var cut = null, hidden = {}, field = document.getElementById('cut-field'), bar = document.getElementById('cut-bar');
  function makeCut(block) {
    var numbers = new Uint8Array(bytes(block.numbers)), map = new Uint8Array(bytes(block.map));
    block.fields.forEach(function (f) { f.parts = new Uint8Array(bytes(f.parts)); });
    var colours = block.materials.map(function (m) { return new THREE.Color(data.materials[m].colour); });
    var strides = [1, block.counts[0], block.counts[0] * block.counts[1]];
    var material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, alphaTest: 0.5 });
    var mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    mesh.visible = false;
    scene.add(mesh);
    document.getElementById('cut').hidden = false;
    ['materials'].concat(block.fields.map(function (f) { return f.name; })).forEach(function (name) {
      var option = document.createElement('option');
      option.textContent = name;
      field.appendChild(option);
    });
    var strip = bar.querySelector('canvas').getContext('2d'), row = strip.createImageData(256, 1);
    for (var n = 0; n < 256; ++n) {
      var c = 3 * Math.min(n, 254);
      row.data.set([map[c], map[c + 1], map[c + 2], 255], 4 * n);
    }
    strip.putImageData(row, 0, 0);
    function texture(axis, layer, u, v) {
      var wide = block.counts[u], high = block.counts[v], pixels = new Uint8Array(4 * wide * high);
      var shown = block.fields[field.selectedIndex - 1];
      for (var y = 0; y < high; ++y) {
        for (var x = 0; x < wide; ++x) {
          var at = layer * strides[axis] + x * strides[u] + y * strides[v], to = 4 * (y * wide + x), m = numbers[at];
          if (m === 255 || hidden[block.materials[m]]) continue;
          if (shown && shown.parts[at] !== 255) {
            pixels.set(map.subarray(3 * shown.parts[at], 3 * shown.parts[at] + 3), to);
          } else {
            pixels.set([255 * colours[m].r, 255 * colours[m].g, 255 * colours[m].b], to);
          }
          pixels[to + 3] = 255;
        }
      }
      var result = new THREE.DataTexture(pixels, wide, high, THREE.RGBAFormat);
      result.needsUpdate = true;
      return result;
    }
    cut = function (axis, constant) {
      mesh.visible = axis >= 0;
      var shown = block.fields[field.selectedIndex - 1];
      bar.hidden = !shown;
      if (shown) {
        bar.querySelectorAll('span')[0].textContent = shown.low;
        bar.querySelectorAll('span')[1].textContent = shown.high;
      }
      if (axis < 0) return;
      var u = (axis + 1) % 3, v = (axis + 2) % 3, min = block.box[0], max = block.box[1];
      var part = (constant - min[axis]) / (max[axis] - min[axis]), last = block.counts[axis] - 1;
      var layer = Math.round(Math.min(Math.max(part, 0), 1) * last), places = [], uvs = [];
      [[0, 0], [1, 0], [1, 1], [0, 1]].forEach(function (corner) {
        var p = [0, 0, 0], ends = [min, max];
        p[axis] = constant - 1e-4 * data.size;
        p[u] = ends[corner[0]][u];
        p[v] = ends[corner[1]][v];
        places = places.concat(p);
        // Points lie in the middles of the texture's squares.
        [u, v].forEach(function (a, n) { uvs.push((0.5 + corner[n] * (block.counts[a] - 1)) / block.counts[a]); });
      });
      mesh.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(places), 3));
      mesh.geometry.setAttribute('uv', new THREE.BufferAttribute(new Float32Array(uvs), 2));
      mesh.geometry.setIndex([0, 1, 2, 0, 2, 3]);
      mesh.geometry.computeBoundingSphere();
      if (material.map) material.map.dispose();
      material.map = texture(axis, layer, u, v);
      material.needsUpdate = true;
    };
    field.addEventListener('change', clip);
  }
  if (data.block) makeCut(data.block);

  var controls = new THREE.OrbitControls(camera, renderer.domElement);
  function reset() {
    var away = new THREE.Vector3().fromArray(data.direction).normalize().multiplyScalar(-1.75 * data.size);
    camera.position.copy(away);
    controls.target.set(0, 0, 0);
    controls.update();
    draw();
  }
  function draw() {
    renderer.render(scene, camera);
    state.state = 'drawn';
    state.triangles = String(renderer.info.render.triangles);
  }
  function fit() {
    var width = view.clientWidth, height = view.clientHeight;
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  }
  controls.addEventListener('change', draw);
  window.addEventListener('resize', fit);

  var list = document.getElementById('materials');
  data.materials.forEach(function (material, n) {
    var isInBlock = data.block && data.block.materials.indexOf(n) >= 0;
    if (!isInBlock && !meshes.some(function (m) { return m.userData.material === n; })) return;
    var label = document.createElement('label'), box = document.createElement('input'),
      swatch = document.createElement('span');
    box.type = 'checkbox';
    box.checked = true;
    box.addEventListener('change', function () {
      meshes.forEach(function (m) { if (m.userData.material === n) m.visible = box.checked; });
      hidden[n] = !box.checked;
      clip();
    });
    swatch.className = 'swatch';
    swatch.style.background = material.colour;
    label.appendChild(box);
    label.appendChild(swatch);
    label.appendChild(document.createTextNode(material.name || 'surface'));
    list.appendChild(label);
  });

  var axis = document.getElementById('clip-axis'), place = document.getElementById('clip-place');
  function clip() {
    var n = ['x', 'y', 'z'].indexOf(axis.value);
    place.disabled = n < 0;
    renderer.clippingPlanes = n < 0 ? [] : [plane];
    if (n >= 0) {
      plane.normal.set(n === 0 ? -1 : 0, n === 1 ? -1 : 0, n === 2 ? -1 : 0);
      plane.constant = data.extent[0][n] + place.value / 1000 * (data.extent[1][n] - data.extent[0][n]);
    }
    if (cut) cut(n, plane.constant);
    state.cut = n < 0 ? '' : axis.value + (cut ? ' ' + field.value : '');
    draw();
  }
  axis.addEventListener('change', clip);
  place.addEventListener('input', clip);
  document.getElementById('reset').addEventListener('click', reset);
  fit();
  reset();
})();
