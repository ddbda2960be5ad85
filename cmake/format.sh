#!/usr/bin/env bash
# Formats the C++ sources of the project, or only says which ones are not formatted.
# usage: cmake/format.sh --fix | --check
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  --fix) options=(-i) ;;
  --check) options=(--dry-run --Werror) ;;
  *) sed -n '2,3p' "$0" >&2; exit 2 ;;
esac
modules=(core catalogues sim photometry analysis reports apps tests)
find "${modules[@]}" \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 -P 2 -n 20 clang-format-14 "${options[@]}" || {
  echo "Not formatted: run 'make format'." >&2
  exit 1
}
