// Turns the views of a report. One WebGL context draws them all, each into a canvas of its own; without WebGL
// the page keeps the still picture that also stands in for the views on paper.
"use strict";

(() => {
  const TURN = 0.5; // degrees a pixel dragged
  const STEP = 10; // degrees an arrow key
  const SPIN = 0.8; // degrees a time
  const CREASE = 24; // degrees: facets that meet under less are one curved side
  const TICK = 16; // milliseconds between two pictures of a trial
  const LONGEST = 10; // seconds a trial plays; a longer one plays faster
  const WIDTH = 680, HEIGHT = 544; // pixels of a view
  const REACH = 1.16; // of the picture over the part
  const COLOURS = { steel: 0xc3d3e4, track: 0xdfe1e4, edge: 0x22303c, accent: 0xd55e00, floor: 0xe3e8ed, parts: 0xed8c33 };

  function renderer() {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!context) return null;
    const made = new THREE.WebGLRenderer({ canvas, context });
    made.setSize(WIDTH, HEIGHT, false);
    return made;
  }

  function decoded(text, Kind) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return new Kind(bytes.buffer);
  }

  // The same facets with a normal for each corner: the mean of those facets around it that meet under less than CREASE.
  function withNormals(geometry) {
    const index = geometry.index.array, flat = geometry.toNonIndexed(), place = flat.attributes.position;
    const normals = [], around = new Map();
    for (let k = 0; k < index.length; k += 3) {
      const [a, b, c] = [0, 1, 2].map((j) => new THREE.Vector3().fromBufferAttribute(place, k + j));
      const normal = b.sub(a).cross(c.sub(a)).normalize();
      normals.push(normal);
      for (const corner of index.subarray(k, k + 3)) {
        if (!around.has(corner)) around.set(corner, []);
        around.get(corner).push(normal);
      }
    }
    const least = Math.cos((CREASE * Math.PI) / 180), mean = new THREE.Vector3(), values = new Float32Array(3 * index.length);
    index.forEach((corner, k) => {
      const own = normals[Math.floor(k / 3)];
      mean.set(0, 0, 0);
      for (const normal of around.get(corner)) if (normal.dot(own) > least) mean.add(normal);
      mean.normalize().toArray(values, 3 * k);
    });
    return flat.setAttribute("normal", new THREE.BufferAttribute(values, 3));
  }

  function surfaceOf(given, colour) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(decoded(given.positions, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(decoded(given.index, Uint32Array), 1));
    const creased = withNormals(geometry);
    const surface = new THREE.MeshStandardMaterial({
      color: colour, metalness: 0.0, roughness: 0.62, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    const edges = new THREE.EdgesGeometry(geometry, CREASE);
    const line = new THREE.LineBasicMaterial({ color: COLOURS.edge, transparent: true, opacity: 0.75 });
    return [new THREE.Mesh(creased, surface), new THREE.LineSegments(edges, line)];
  }

  function contactLines() {
    const through = { color: COLOURS.accent, depthTest: false, transparent: true };
    return [
      new THREE.LineLoop(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ ...through, opacity: 0.55 })),
      new THREE.Mesh(
        new THREE.BufferGeometry(),
        new THREE.MeshBasicMaterial({ color: COLOURS.accent, transparent: true, opacity: 0.4, side: 2, depthWrite: false,
          polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }),
      ),
    ];
  }

  function centreMark(data) {
    const material = new THREE.MeshBasicMaterial({ color: COLOURS.accent, depthTest: false, transparent: true, opacity: 0.85 });
    const mark = new THREE.Mesh(new THREE.SphereGeometry(0.022 * data.radius, 16, 12), material);
    mark.renderOrder = 2;
    return mark;
  }

  function floorDisc(data) {
    const material = new THREE.MeshBasicMaterial({ color: COLOURS.floor, transparent: true, opacity: 0.55, depthWrite: false });
    const disc = new THREE.Mesh(new THREE.CircleGeometry(data.radius, 96), material);
    disc.position.z = -0.004 * data.radius;
    return disc; // seen from above only, so that from below the contact face is free
  }

  function trackOf(given) {
    const group = new THREE.Group();
    group.add(...surfaceOf(given, COLOURS.track));
    return group;
  }

  function stage(data) {
    const scene = new THREE.Scene(), part = new THREE.Group();
    const contact = contactLines(), lamp = new THREE.DirectionalLight(0xffffff, 2.1), fill = new THREE.DirectionalLight(0xffffff, 0.7);
    const paths = (data.paths || []).map((path) => decoded(path, Float32Array));
    const tracks = (data.tracks || []).map(trackOf), floor = floorDisc(data);
    part.add(...surfaceOf(data, COLOURS[data.colour || "steel"]), ...contact, ...(data.unmarked ? [] : [centreMark(data)]));
    scene.add(part, floor, ...tracks, new THREE.HemisphereLight(0xffffff, 0xd8dee5, 1.9), lamp, fill);
    const tall = REACH * (data.reach || 1) * data.radius, wide = (tall * WIDTH) / HEIGHT;
    const camera = new THREE.OrthographicCamera(-wide, wide, tall, -tall, 0.1 * data.radius, 20 * data.radius);
    camera.up.set(0, 0, 1);
    return { data, scene, part, contact, tracks, paths, floor, lamp, fill, camera };
  }

  function placePart({ part, contact, tracks, floor }, pose) {
    tracks.forEach((track, k) => (track.visible = k === pose.track));
    floor.visible = pose.track === undefined;
    part.quaternion.set(...pose.quaternion);
    part.position.set(0, 0, pose.height);
    const corners = new THREE.BufferAttribute(new Float32Array(pose.contact), 3), fan = [];
    for (let k = 1; k + 1 < corners.count; k++) fan.push(0, k, k + 1);
    for (const line of contact) {
      line.geometry.dispose();
      line.geometry = new THREE.BufferGeometry().setAttribute("position", corners).setIndex(line.isMesh ? fan : null);
    }
  }

  // A path has 8 numbers a row: time, place, attitude. Places between rows are on a straight line.
  function placeOnPath({ part }, path, time) {
    let low = 0, high = path.length / 8 - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (path[8 * middle] > time) high = middle;
      else low = middle;
    }
    const span = path[8 * high] - path[8 * low], share = span > 0 ? Math.min(1, Math.max(0, (time - path[8 * low]) / span)) : 0;
    const [a, b] = [low, high].map((row) => path.subarray(8 * row + 1, 8 * row + 8));
    part.position.set(a[0], a[1], a[2]).lerp(new THREE.Vector3(b[0], b[1], b[2]), share);
    part.quaternion.set(a[3], a[4], a[5], a[6]).slerp(new THREE.Quaternion(b[3], b[4], b[5], b[6]), share);
  }

  function placeCamera({ data, camera, lamp, fill }, view, target) {
    const a = (view.azimuth * Math.PI) / 180, e = (view.elevation * Math.PI) / 180, far = 8 * data.radius;
    const out = new THREE.Vector3(Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e));
    camera.position.copy(out).multiplyScalar(far).add(target);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    lamp.position.set(-0.45, 0.6, 0.66).applyQuaternion(camera.quaternion);
    fill.position.set(0.75, 0.05, 0.66).applyQuaternion(camera.quaternion);
  }

  function start(view, data) {
    Object.assign(view, { azimuth: data.azimuth, elevation: data.elevation });
  }

  function turn(view, across, up) {
    view.azimuth -= across;
    view.elevation = Math.max(-89, Math.min(89, view.elevation + up));
    view.draw();
  }

  function listen(canvas, view, data) {
    const keys = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };
    let last = null;
    canvas.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture?.(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      turn(view, TURN * (event.clientX - last[0]), TURN * (event.clientY - last[1]));
      last = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (last = null));
    canvas.addEventListener("spin", () => turn(view, SPIN, 0)); // of a page around this one
    canvas.addEventListener("dblclick", () => { start(view, data); view.draw(); });
    canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      turn(view, ...keys[event.key]);
    });
    const button = canvas.parentElement.querySelector("button");
    button.addEventListener("click", () => {
      const above = view.elevation > 0;
      view.elevation = above ? -50 : data.elevation;
      button.textContent = above ? "from above" : "from below";
      view.draw();
    });
  }

  function play(figure, view, path) {
    const last = path[path.length - 8], quick = Math.max(1, last / LONGEST);
    const button = figure.querySelector(".play"), bar = figure.querySelector("input"), clock = figure.querySelector("output");
    let ticking = null, before = 0;
    const reach = (time) => {
      view.time = Math.min(Math.max(time, 0), last);
      bar.value = view.time / last;
      clock.textContent = `${view.time.toFixed(2)} s`;
      view.draw();
    };
    const run = (on) => {
      clearInterval(ticking);
      ticking = on ? setInterval(tick, TICK) : null;
      button.textContent = on ? "pause" : "play";
      before = performance.now();
    };
    const tick = () => {
      const now = performance.now();
      reach(view.time + (quick * (now - before)) / 1000);
      before = now;
      if (view.time >= last) run(false);
    };
    button.addEventListener("click", () => {
      if (!ticking && view.time >= last) reach(0);
      run(!ticking);
    });
    bar.addEventListener("input", () => { run(false); reach(bar.value * last); });
  }

  function show(pen, set, canvas) {
    const view = { time: 0 }, data = set.data, pose = data.poses[Number(canvas.dataset.pose)], paper = canvas.getContext("2d");
    const path = set.paths[pose.path];
    canvas.width = WIDTH;
    canvas.height = HEIGHT;
    view.draw = () => {
      placePart(set, pose);
      if (path) placeOnPath(set, path, view.time);
      placeCamera(set, view, set.part.position);
      pen.render(set.scene, set.camera);
      paper.clearRect(0, 0, WIDTH, HEIGHT);
      paper.drawImage(pen.domElement, 0, 0);
    };
    start(view, data);
    listen(canvas, view, data);
    if (path) play(canvas.parentElement, view, path);
    view.draw();
  }

  const pen = renderer();
  if (!pen) return;
  document.body.classList.add("has-views");
  for (const given of document.querySelectorAll("script.scene")) {
    const set = stage(JSON.parse(given.textContent)), block = document.getElementById(given.dataset.views);
    block.hidden = false;
    for (const canvas of block.querySelectorAll(".view canvas")) show(pen, set, canvas);
  }
})();
