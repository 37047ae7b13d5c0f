#!/usr/bin/env bash
# The page's pure functions under node's test runner: node_tests.sh FOLDER_FOR_BUNDLES
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
export FOOTLIGHT_WEB=$here/../../app/console/web
mkdir -p "$1"
esbuild "$here"/*.test.mjs --bundle --platform=node --format=esm --out-extension:.js=.mjs --log-level=warning --outdir="$1"
exec node --test "$1"
