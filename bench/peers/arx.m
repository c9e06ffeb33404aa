% The Octave part of bench/peers/arx.py: octave-cli -q arx.m FOLDER. Prints "octave CASE MILLISECONDS".
1;
pkg load control
function data = rows_of(file, columns)
  stream = fopen(file, 'r');
  data = reshape(fread(stream, Inf, 'double'), columns, [])';
  fclose(stream);
end
function report(name, work)
  work();
  times = zeros(1, 3);
  for k = 1:3
    start = cputime();
    work();
    times(k) = cputime() - start;
  end
  printf('octave %s %.3f\n', name, 1e3 * median(times));
end
folder = argv(){end};
% Every output of a full model is a call of its own, with the other output as an input.
D = rows_of(fullfile(folder, 'mimo100k.bin'), 3);
first = iddata(D(:, 2), D(:, [1 3]), 1);
second = iddata(D(:, 3), D(:, [1 2]), 1);
function both(first, second)
  arx(first, 'na', 4, 'nb', 4);
  arx(second, 'na', 4, 'nb', 4);
end
report('fit_two_outputs/0', @() both(first, second));
S = rows_of(fullfile(folder, 'siso100k.bin'), 2);
single = iddata(S(2:end, 2), S(1:end-1, 1), 1);
report('fit_one_output', @() arx(single, 'na', 4, 'nb', 4));
