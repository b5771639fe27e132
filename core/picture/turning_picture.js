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
    if (!meshes.some(function (m) { return m.userData.material === n; })) return;
    var label = document.createElement('label'), box = document.createElement('input'),
      swatch = document.createElement('span');
    box.type = 'checkbox';
    box.checked = true;
    box.addEventListener('change', function () {
      meshes.forEach(function (m) { if (m.userData.material === n) m.visible = box.checked; });
      draw();
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
    draw();
  }
  axis.addEventListener('change', clip);
  place.addEventListener('input', clip);
  document.getElementById('reset').addEventListener('click', reset);
  fit();
  reset();
})();
