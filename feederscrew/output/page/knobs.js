// The conveying kernel of feederscrew/motion in the page, for a drive without second harmonic, and the knobs that
// turn its drive. Angles in radians, lengths in units of the half stroke A, velocities in A w, as in docs/conveying.md.
"use strict";

const conveying = (() => {
  const TURN = 2 * Math.PI, STICK = 0, FORWARD = 1, BACKWARD = 2, FLIGHT = 3, INF = Infinity;
  const GRAZE = 1e-14, SERIES = 0.5, TIE = 1e-12, CLOSE = 1e-14, STEPS = 80, LATE = 10, SETTLED = 1e-6, EVENTS = 100000;
  const LONGEST = 32, SIZE = LONGEST + 1, TRANSIENT = 400, SAME = 1e-12, FIRST_LEAP = 4, LEAST_LEAP = 1e-11;
  const LONGEST_LEAP = 10, RUNS = -1, LEAPS = 200, BRACKET = 1e-13, FASTEST = 1e6, BLOCK = 32, BLOCKS = 8, LOTS = 16;
  const STILL = 1e-9, ROUNDING = 1e-9;
  const REGIMES = ["stick", "forward", "backward", "both", "hop"];

  const turned = (x) => { const rest = x % TURN; return rest < 0 ? rest + TURN : rest; };

  // level + swing sin(angle + phase), with the angles where it rises and falls through zero
  function harmonic(level, sine, cosine) {
    const swing = Math.hypot(sine, cosine), phase = Math.atan2(cosine, sine);
    if (Math.abs(level) >= swing * (1 - GRAZE)) return { level, swing, phase, rise: INF, fall: INF };
    const crossing = Math.asin(-level / swing);
    return { level, swing, phase, rise: turned(crossing - phase), fall: turned(Math.PI - crossing - phase) };
  }
  const value = (a, angle) => a.level + a.swing * Math.sin(angle + a.phase);
  const peak = (a) => a.level + a.swing;
  const after = (zero, angle) => (zero > angle ? zero : INF);
  const later = (zero, now) => (zero >= now - TIE ? Math.max(zero, now) : INF);
  function above(a, angle) {
    let rise = after(a.rise, angle), fall = after(a.fall, angle);
    if (rise === fall) [rise, fall] = [a.rise, a.fall];
    return fall < rise;
  }
  const onward = (a, start) => ({ level: a.level, sine: a.swing * Math.sin(start + a.phase), cosine: a.swing * Math.cos(start + a.phase) });
  function reached(arc, span) {
    const s = Math.sin(0.5 * span), c = Math.cos(0.5 * span);
    return arc.level + arc.sine + 2 * s * (arc.cosine * c - arc.sine * s);
  }
  function gain(arc, span) {
    const s = Math.sin(0.5 * span), c = Math.cos(0.5 * span);
    return arc.level * span + 2 * s * (arc.sine * c + arc.cosine * s);
  }
  function travel(arc, span) {
    return 0.5 * (arc.level + arc.sine) * span * span + arc.cosine * beyondSine(span) - arc.sine * beyondCosine(span);
  }
  function beyondSine(x) { // x - sin x
    if (Math.abs(x) > SERIES) return x - 2 * Math.sin(0.5 * x) * Math.cos(0.5 * x);
    const y = x * x, tail = 1 - (y / 72) * (1 - (y / 110) * (1 - y / 156));
    return ((x * y) / 6) * (1 - (y / 20) * (1 - (y / 42) * tail));
  }
  function beyondCosine(x) { // x^2 / 2 - 1 + cos x
    if (Math.abs(x) > SERIES) return 0.5 * x * x - 2 * Math.sin(0.5 * x) ** 2;
    const y = x * x, tail = 1 - (y / 90) * (1 - (y / 132) * (1 - y / 182));
    return ((y * y) / 24) * (1 - (y / 30) * (1 - (y / 56) * tail));
  }

  function pull(point, direction, friction) {
    const along = direction * Math.cos(point.angle), normal = friction * Math.sin(point.angle);
    const level = (-direction * Math.sin(point.climb)) / point.ratio - (friction * Math.cos(point.climb)) / point.ratio;
    return harmonic(level, along * Math.cos(point.lead) + normal, along * Math.sin(point.lead));
  }
  function law(point) {
    return {
      lift: harmonic(-Math.cos(point.climb) / point.ratio, Math.sin(point.angle), 0),
      free: pull(point, 1, 0), onset: pull(point, 1, point.static), onsetBack: pull(point, -1, point.staticBack),
      slip: pull(point, 1, point.kinetic), slipBack: pull(point, -1, point.kineticBack),
      kinetic: point.kinetic, kineticBack: point.kineticBack, restitution: point.restitution,
    };
  }
  const throwNumber = (rules) => 1 - peak(rules.lift) / rules.lift.level;
  function regime(rules) {
    if (throwNumber(rules) >= 1 - ROUNDING) return 4;
    return (peak(rules.onset) > 0 ? 1 : 0) + (peak(rules.onsetBack) > 0 ? 2 : 0);
  }
  function contact(rules, angle, speed) {
    if (above(rules.lift, angle)) return FLIGHT;
    if (speed > 0 || (speed === 0 && value(rules.onset, angle) > 0)) return FORWARD;
    return speed < 0 || value(rules.onsetBack, angle) > 0 ? BACKWARD : STICK;
  }

  function slipEnd(a, angle, speed) {
    const closing = speed > 0 && value(a, angle) < 0, arc = onward(a, angle);
    let start = closing ? angle : later(a.fall, angle);
    while (start < TURN) {
      const end = Math.min(after(a.rise, start), TURN);
      if (speed + gain(arc, end - angle) <= 0) return angle + stop(arc, speed, start - angle, end - angle, turned(1.5 * Math.PI - a.phase - angle));
      start = later(a.fall, end);
    }
    return INF;
  }
  function stop(arc, speed, low, high, steepest) {
    let x = Math.min(Math.max(steepest, low), high), last = INF;
    for (let count = 0; count < STEPS; count++) {
      const left = speed + gain(arc, x), slope = reached(arc, x);
      if (Math.abs(left) <= -slope * CLOSE * x) return x - left / slope;
      if (left > 0) low = x;
      else high = x;
      let next = slope < 0 ? x - left / slope : low;
      if (!(low < next && next < high) || (count > LATE && Math.abs(next - x) > 0.5 * last)) next = 0.5 * (low + high);
      [x, last] = [next, Math.abs(next - x)];
    }
    return x;
  }
  function landing(lift, angle, height, speed) {
    const arc = onward(lift, angle);
    let start = angle;
    while (start < TURN) {
      const hollow = above(lift, start), end = Math.min(after(hollow ? lift.fall : lift.rise, start), TURN);
      const down = hollow ? dip(arc, height, speed, start - angle, end - angle) : descent(arc, height, speed, end - angle);
      if (down < INF) return angle + down;
      start = end;
    }
    return INF;
  }
  function descent(arc, height, speed, end) {
    if (height + speed * end + travel(arc, end) > 0) return INF;
    let x = end;
    if (height === 0 && speed > 0) {
      x = (2 * speed) / Math.max(-reached(arc, 0), speed);
      while (x < end && speed * x + travel(arc, x) > 0) x *= 2;
      x = Math.min(x, end);
    }
    for (let count = 0; count < STEPS; count++) {
      const step = (height + speed * x + travel(arc, x)) / (speed + gain(arc, x));
      x -= step;
      if (Math.abs(step) <= CLOSE * x) break;
    }
    return x;
  }
  function dip(arc, height, speed, start, end) {
    let x = start;
    for (let count = 0; count < STEPS; count++) {
      const sinking = speed + gain(arc, x);
      if (sinking >= 0) return INF;
      const step = (height + speed * x + travel(arc, x)) / sinking;
      x -= step;
      if (x > end) return INF;
      if (Math.abs(step) <= CLOSE * x) break;
    }
    return x;
  }

  const state = (angle, phase, speed, height, rising) => ({ angle, phase, speed, height, rising });
  const tallied = () => ({ way: 0, stops: 0, up: 0, down: 0 });

  function step(rules, now, tally) {
    if (now.phase === FLIGHT) return fly(rules, now, tally);
    return now.phase === STICK ? ride(rules, now, tally) : slide(rules, now, tally);
  }
  function ride(rules, now, tally) {
    const lift = later(rules.lift.rise, now.angle), ahead = later(rules.onset.rise, now.angle), back = later(rules.onsetBack.rise, now.angle);
    const end = Math.min(lift, ahead, back, TURN);
    tally.stops += 1;
    return state(end, lift === end ? FLIGHT : ahead === end ? FORWARD : back === end ? BACKWARD : STICK, 0, 0, 0);
  }
  function slide(rules, now, tally) {
    const ahead = now.phase === FORWARD, sign = ahead ? 1 : -1, growth = ahead ? rules.slip : rules.slipBack;
    const lift = later(rules.lift.rise, now.angle), halt = slipEnd(growth, now.angle, Math.abs(now.speed));
    const end = Math.min(lift, halt, TURN), span = end - now.angle, arc = onward(growth, now.angle);
    tally.way += now.speed * span + sign * travel(arc, span);
    tally[ahead ? "up" : "down"] += 1;
    const speed = now.speed + sign * gain(arc, span);
    if (lift === end) return state(end, FLIGHT, speed, 0, 0);
    if (halt === end) {
      tally.stops += 1;
      return state(end, contact(rules, end, 0), 0, 0, 0);
    }
    return state(end, now.phase, speed, 0, 0);
  }
  function fly(rules, now, tally) {
    const down = landing(rules.lift, now.angle, now.height, now.rising), end = Math.min(down, TURN), span = end - now.angle;
    const along = onward(rules.free, now.angle), normal = onward(rules.lift, now.angle);
    tally.way += now.speed * span + travel(along, span);
    const speed = now.speed + gain(along, span), rising = now.rising + gain(normal, span);
    if (down > TURN) return state(end, FLIGHT, speed, now.height + now.rising * span + travel(normal, span), rising);
    const landed = land(rules, end, speed, -rising);
    tally[landed.speed === 0 ? "stops" : landed.speed > 0 ? "up" : "down"] += 1;
    return landed;
  }
  function land(rules, angle, speed, impact) {
    const friction = speed > 0 ? rules.kinetic : rules.kineticBack;
    let rebound = rules.restitution * impact;
    if (rebound <= SETTLED * Math.max(0, -value(rules.lift, angle))) rebound = 0;
    const loss = Math.min(Math.abs(speed), friction * (impact + rebound));
    const left = speed - (speed < 0 ? -loss : loss);
    return state(angle, rebound > 0 ? FLIGHT : contact(rules, angle, left), left, 0, rebound);
  }
  function period(rules, now, tally) {
    for (let count = 0; count < EVENTS && now.angle < TURN; count++) now = step(rules, now, tally);
    return state(0, now.phase, now.speed, now.height, now.rising);
  }
  const atRest = (rules) => state(0, contact(rules, 0, 0), 0, 0, 0);
  const atSpeed = (rules, now, speed) => state(now.angle, now.phase === FLIGHT ? FLIGHT : contact(rules, now.angle, speed), speed, now.height, now.rising);
  function periods(rules, now, count, tally) {
    tally.stops = tally.up = tally.down = 0;
    for (let k = 0; k < count; k++) now = period(rules, now, tally);
    return now;
  }
  const normalApart = (row, now) => Math.max(Math.abs(now.height - row[1]), Math.abs(now.rising - row[2]));

  // Follow a part until its state repeats every q periods, twice in a row: [state, q], q RUNS or 0 where it does not.
  function settle(rules, now) {
    const tally = tallied(), history = [], streak = new Array(SIZE).fill(0);
    const even = rules.onset.level === rules.slip.level && rules.onsetBack.level === rules.slipBack.level && Math.min(rules.kinetic, rules.kineticBack) > 0;
    let sliding = 0, sense = 0;
    for (let count = 0; count < TRANSIENT; count++) {
      now = periods(rules, now, 1, tally);
      [sliding, sense] = slid(tally, sliding, sense);
      const repeat = repeats(history, streak, count, now);
      if (repeat) return [now, sliding >= repeat && sense !== 0 ? RUNS : repeat];
      if (sense !== 0 && grows(history, count, now, sliding, sense)) return [now, RUNS];
      if (even && count >= FIRST_LEAP) {
        const before = now.speed;
        now = leap(rules, history, count, now, tally);
        if (now.speed !== before) {
          [sliding, sense] = [0, 0];
          history[count % SIZE][0] = now.speed;
        }
      }
    }
    return hasten(rules, now, periodOfNormal(history, TRANSIENT - 1), tally);
  }
  function slid(tally, sliding, sense) {
    const up = tally.up > 0, down = tally.down > 0;
    if (tally.stops > 0 || (up && down)) return [0, 0];
    const now = up ? 1 : down ? -1 : 0;
    return now * sense < 0 ? [1, now] : [sliding + 1, now === 0 ? sense : now];
  }
  function repeats(history, streak, count, now) {
    for (let q = 1; q <= Math.min(count, LONGEST); q++) {
      const row = history[(count - q) % SIZE];
      const apart = Math.max(Math.abs(now.speed - row[0]), normalApart(row, now));
      streak[q] = apart <= SAME ? streak[q] + 1 : 0;
      if (streak[q] === 2) return q;
    }
    history[count % SIZE] = [now.speed, now.height, now.rising];
    return 0;
  }
  function grows(history, count, now, sliding, sense) {
    for (let q = 1; q <= Math.min(count, sliding, LONGEST); q++) {
      const row = history[(count - q) % SIZE];
      if (normalApart(row, now) <= SAME) return sense * (now.speed - row[0]) > SAME;
    }
    return false;
  }
  function leap(rules, history, count, now, tally) {
    const one = history[(count - 1) % SIZE], two = history[(count - 2) % SIZE];
    if (normalApart(one, now) > SAME || normalApart(two, now) > SAME) return now;
    const first = one[0] - two[0], second = now.speed - one[0];
    if (!(0 < second * first && second * first < first * first && Math.abs(second) > LEAST_LEAP)) return now;
    const beyond = (second * second) / (first - second);
    if (Math.abs(beyond) > LONGEST_LEAP) return now;
    const there = atSpeed(rules, now, now.speed + beyond);
    const change = periods(rules, there, 1, tally).speed - there.speed;
    return Math.abs(change) < Math.abs(second) ? there : now;
  }
  function periodOfNormal(history, count) {
    for (let q = 1; q < LONGEST; q++) {
      let apart = 0;
      for (let back = 0; back < 2; back++) {
        const one = history[(count - back) % SIZE], other = history[(count - back - q) % SIZE];
        apart = Math.max(apart, Math.abs(one[1] - other[1]), Math.abs(one[2] - other[2]));
      }
      if (apart <= SAME) return q;
    }
    return 0;
  }
  function hasten(rules, now, repeat, tally) {
    let width = periods(rules, now, repeat, tally).speed - now.speed;
    if (width === 0) return [now, repeat];
    let near = now.speed, rise = width, far = now.speed, fall = width;
    while (fall * rise > 0) {
      [near, rise] = [far, fall];
      far = near + width;
      fall = periods(rules, atSpeed(rules, now, far), repeat, tally).speed - far;
      const runs = tally.stops === 0 && tally.up > 0 !== tally.down > 0;
      if ((runs && fall * rise > 0 && fall * far > 0) || Math.abs(width) > FASTEST) return [now, RUNS];
      width *= 2;
    }
    for (let count = 0, side = 0; count < LEAPS && Math.abs(far - near) > BRACKET && fall !== 0; count++) {
      const middle = far - (fall * (far - near)) / (fall - rise);
      const gained = periods(rules, atSpeed(rules, now, middle), repeat, tally).speed - middle;
      if (gained * rise > 0) {
        [near, rise] = [middle, gained];
        if (side === 1) fall *= 0.5;
        side = 1;
      } else {
        [far, fall] = [middle, gained];
        if (side === -1) rise *= 0.5;
        side = -1;
      }
    }
    return [atSpeed(rules, now, far), repeat];
  }

  // Velocity [A w] of a part that starts at rest: [velocity, status]; NaN where it slides on without end.
  function steady(rules) {
    if (rules.onset.level === 0 && rules.onsetBack.level === 0) return [NaN, "no steady state"];
    let [now, repeat] = settle(rules, atRest(rules));
    if (repeat === RUNS) return [NaN, "no steady state"];
    const tally = tallied();
    if (repeat > 0) {
      for (let k = 0; k < repeat; k++) now = period(rules, now, tally);
      return [tally.way / (repeat * TURN), "periodic"];
    }
    const escape = Math.max(rules.slip.level, rules.slipBack.level);
    for (let lot = 0; ; lot++) {
      const lap = tallied(), first = now.speed;
      for (let k = 0; k < BLOCKS * BLOCK; k++) now = period(rules, now, lap);
      const runs = lap.stops === 0 && (lap.up === 0) !== (lap.down === 0) && (now.speed - first) * now.speed > 0;
      if (runs) return [NaN, "no steady state"];
      if (escape <= 0 || lot + 1 === LOTS) return [lap.way / (BLOCKS * BLOCK * TURN), "averaged"];
    }
  }

  // An operating point in SI units, of a bowl with a bank: floor and wall together as one friction.
  function pointOf(bowl) {
    const held = (friction) => friction / Math.cos(bowl.bank) + bowl.wall * Math.tan(bowl.bank);
    const omega = TURN * bowl.frequency;
    return {
      ratio: Math.max((bowl.amplitude * omega * omega) / bowl.gravity, STILL), angle: bowl.angle, climb: bowl.climb, lead: -bowl.phase,
      static: held(bowl.static), kinetic: held(bowl.kinetic), staticBack: held(bowl.staticBack), kineticBack: held(bowl.kineticBack),
      restitution: bowl.restitution,
    };
  }
  function answer(bowl) {
    const rules = law(pointOf(bowl)), [velocity, status] = steady(rules);
    return {
      velocity: velocity * bowl.amplitude * TURN * bowl.frequency, status, throwNumber: throwNumber(rules),
      regime: status === "no steady state" ? status : REGIMES[regime(rules)],
    };
  }
  return { answer, regime: (bowl) => regime(law(pointOf(bowl))) };
})();

(() => {
  const DEG = Math.PI / 180, FRICTIONS = ["static", "kinetic", "staticBack", "kineticBack", "wall"];
  const SCALE = { amplitude: 1e-3, frequency: 1, angle: DEG, phase: DEG, climb: DEG };
  const ANGLES = [2, 60]; // degrees over which the map goes

  function number(value, digits) {
    return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "–";
  }

  // The bowl with what the sliders say; friction is that of rest, the others go with it.
  function bowlOf(data, typed) {
    const bowl = { ...data.bowl };
    for (const [name, scale] of Object.entries(SCALE)) bowl[name] = typed[name] * scale;
    for (const name of FRICTIONS) bowl[name] = (data.bowl[name] * typed.friction) / data.bowl.static;
    return bowl;
  }

  // Parts a minute that leave as wanted at a velocity [m/s], by the chain of the report's rate.
  function rateAt(data, velocity) {
    if (!data.rate || !(velocity > 0)) return data.rate && velocity <= 0 ? 0 : NaN;
    const offered = 1 / (1 / (velocity * data.rate.density) + data.rate.blocked);
    return 60 * Math.min(offered * data.rate.efficiency, velocity / data.rate.length);
  }

  function drawMap(block, data, bowl, typed) {
    const canvas = block.querySelector("canvas"), pen = canvas.getContext("2d"), top = data.top;
    const wide = canvas.width, high = canvas.height, columns = 144, rows = 88;
    for (let i = 0; i < columns; i++)
      for (let j = 0; j < rows; j++) {
        const angle = (ANGLES[0] + ((ANGLES[1] - ANGLES[0]) * (i + 0.5)) / columns) * DEG, amplitude = ((rows - j - 0.5) / rows) * top * 1e-3;
        pen.fillStyle = data.regimes[conveying.regime({ ...bowl, angle, amplitude })][1];
        pen.fillRect(Math.floor((i * wide) / columns), Math.floor((j * high) / rows), Math.ceil(wide / columns) + 1, Math.ceil(high / rows) + 1);
      }
    pen.font = "20px sans-serif";
    pen.lineWidth = 5;
    pen.strokeStyle = "#fff";
    pen.fillStyle = "#22303c";
    const label = (text, x, y, align) => { pen.textAlign = align; pen.strokeText(text, x, y); pen.fillText(text, x, y); };
    for (let angle = 10; angle <= 50; angle += 10) label(angle === 50 ? "50 deg" : String(angle), ((angle - ANGLES[0]) / (ANGLES[1] - ANGLES[0])) * wide, high - 8, "center");
    for (let k = 1; k <= 3; k++) label(`${number((k * top) / 4, 2)}${k === 3 ? " mm" : ""}`, 8, high * (1 - k / 4) + 7, "left");
    const x = ((typed.angle - ANGLES[0]) / (ANGLES[1] - ANGLES[0])) * wide, y = (1 - typed.amplitude / top) * high;
    pen.beginPath();
    pen.arc(x, y, 8, 0, 2 * Math.PI);
    pen.fillStyle = "#d55e00";
    pen.fill();
    pen.lineWidth = 2.5;
    pen.strokeStyle = "#fff";
    pen.stroke();
  }

  function start(block) {
    const data = JSON.parse(block.querySelector("script.knob-values").textContent);
    const sliders = Object.fromEntries([...block.querySelectorAll("input")].map((input) => [input.name, input]));
    const own = Object.fromEntries(Object.entries(sliders).map(([name, input]) => [name, Number(input.dataset.own)]));
    const shown = (name, text) => {
      const place = block.querySelector(`[data-shows="${name}"]`);
      if (place) place.textContent = text;
    };
    let typed = { ...own };
    function follow() {
      const bowl = bowlOf(data, typed), found = conveying.answer(bowl);
      const words = Object.fromEntries(data.regimes.map(([name, , text]) => [name, text]));
      for (const [name, input] of Object.entries(sliders)) {
        input.value = typed[name];
        input.parentElement.querySelector("output").textContent = `${number(typed[name], 4)} ${input.dataset.unit}`;
      }
      shown("velocity", `${number(1e3 * found.velocity, 3)} mm/s`);
      shown("regime", words[found.regime] || found.regime);
      shown("throw", number(found.throwNumber, 3));
      shown("stroke", `${number(2 * typed.amplitude, 3)} mm`);
      shown("rate", `${number(rateAt(data, found.velocity), 3)} a minute`);
      drawMap(block, data, bowl, typed);
    }
    for (const [name, input] of Object.entries(sliders))
      input.addEventListener("input", () => { typed[name] = Number(input.value); follow(); });
    block.querySelector("button").addEventListener("click", () => { typed = { ...own }; follow(); });
    block.querySelector("canvas").addEventListener("click", (event) => {
      const box = event.target.getBoundingClientRect();
      typed.angle = ANGLES[0] + ((ANGLES[1] - ANGLES[0]) * (event.clientX - box.left)) / box.width;
      typed.amplitude = Math.max(data.top * (1 - (event.clientY - box.top) / box.height), Number(sliders.amplitude.min));
      follow();
    });
    block.hidden = false;
    follow();
  }
  document.querySelectorAll(".knobs").forEach(start);
})();
