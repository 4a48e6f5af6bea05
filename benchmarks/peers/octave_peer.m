% GNU Octave: ode45, and fminunc on its motions.
% Usage: octave-cli octave_peer.m FOLDER [--quick]    prints results as harness.py does
1;

function f = curve(c, s)
  f = interp1(c.knots, c.ordinates, min(abs(s), c.knots(end)));
end

function a = acceleration(m, x, v)
  a = -(curve(m.spring, x) .* x + curve(m.damper, v) .* v) / m.mass;
end

function channels = simulate(m, times, tolerance)
  options = odeset("RelTol", tolerance, "AbsTol", tolerance);
  [~, y] = ode45(@(t, y) [y(2); acceleration(m, y(1), y(2))], times, [0; m.speed], options);
  channels = [y, acceleration(m, y(:, 1), y(:, 2))]';
end

function m = with_places(m, places, bounds)  % squared: fminunc knows no bounds
  ordinates = places .^ 2 .* bounds;
  count = numel(m.spring.ordinates);
  m.spring.ordinates = ordinates(1:count);
  m.damper.ordinates = ordinates(count+1:end);
end

function e = fit_error(m, w)
  channels = simulate(m, w.times, 1e-6);
  e = sum(mean(abs(channels - w.target), 2) ./ max(abs(w.target), [], 2));
end

function report(workload, engine, seconds, varargin)
  printf("%s\n", jsonencode(struct("workload", workload, "engine", engine, "seconds", seconds, varargin{:})));
end

function forward(folder, quick)
  w = jsondecode(fileread([folder "/w1.json"]));
  models = ifelse(quick, 3, 10);
  for tolerance = [1e-4, 1e-6, 1e-8]
    seconds = errors = zeros(1, models);
    for i = 1:models
      start = cputime();
      channels = simulate(w.models(i), w.times, tolerance);
      seconds(i) = cputime() - start;
      reference = squeeze(w.reference(i, :, :));
      errors(i) = max(max(abs(channels - reference), [], 2) ./ max(abs(reference), [], 2));
    end
    error_90 = sort(errors)(ceil(0.9 * models));
    report("W1", "Octave ode45", median(seconds), "rtol", tolerance, "error", error_90, "models", models);
  end
end

function fit(folder)
  w = jsondecode(fileread([folder "/w2.json"]));
  count = numel(w.truth.spring.ordinates);
  bounds = [w.spring_upper * ones(count, 1); w.damper_upper * ones(numel(w.truth.damper.ordinates), 1)];
  places = sqrt(w.starts(1, :)' ./ bounds);
  start = cputime();
  [~, e] = fminunc(@(p) fit_error(with_places(w.truth, p, bounds), w), places);
  report("W2", "Octave ode45 + fminunc", 100 * (cputime() - start), "starts", 1, "E", e);
end

function v = ifelse(condition, a, b)
  if condition v = a; else v = b; end
end

arguments = argv();
quick = any(strcmp(arguments, "--quick"));
forward(arguments{1}, quick);
if !quick fit(arguments{1}); end
