# Sourced by scripts that run several checks at once. `start NAME COMMAND...` begins one; `finish` waits for all, prints
# what those say that fail, and fails when one of them does.

started=()
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

start() {
  started+=("$1")
  (
    ("${@:2}") >"$folder/${#started[@]}.log" 2>&1
    echo $? >"$folder/${#started[@]}.status"
  ) &
}

finish() {
  local i failures=()
  wait
  for i in "${!started[@]}"; do
    [ "$(cat "$folder/$((i + 1)).status")" = 0 ] && continue
    failures+=("${started[i]}")
    printf '== %s\n' "${started[i]}"
    cat "$folder/$((i + 1)).log"
  done
  [ ${#failures[@]} -eq 0 ] && return
  printf 'failed: %s\n' "${failures[@]}"
  return 1
}
