#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the documentation site in build/docs/html from the pages of the repository, without network. Warnings are errors,
# links that lead nowhere among them. `scripts/setup.sh --docs` installs what it needs; the Python module comes from the build.
#
#   scripts/docs.sh [BUILD [OUTPUT]]    BUILD: the tree with the Python module, build/release; OUTPUT: build/docs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=${1:-build/release}
output=${2:-build/docs}
export ISOSTAT_PYTHONPATH="$(realpath "$build")/python"
if [[ ! -d "$ISOSTAT_PYTHONPATH/isostat" ]]; then
  echo "docs: $build/python has no module isostat; run cmake --build --preset release first" >&2
  exit 1
fi
for tool in sphinx-build doxygen; do
  if ! command -v "$tool" >/dev/null; then
    echo "docs: $tool is missing; run scripts/setup.sh --docs" >&2
    exit 1
  fi
done

site=$output/html.part # becomes $output/html when it is whole
rm -rf "$site"
mkdir -p "$site"
sphinx-build -W --keep-going -q -c docs/site -d "$output/doctrees" -b html . "$site"
rm -rf "$site/cpp"
(cat docs/site/Doxyfile; echo "OUTPUT_DIRECTORY = $output"; echo "HTML_OUTPUT = html.part/cpp") | doxygen -
# Doxygen names a list of nested classes that it leaves out where all of them are private.
{ grep -rlF '#nested-classes"' "$site/cpp" | xargs grep -LF 'name="nested-classes"' || true; } |
  xargs -r sed -i 's|<a href="#nested-classes">[^<]*</a>[^<]*||'

# Debian's theme takes a style from the root of a web server and a script as a module: put both into the site, so that
# pages can be opened as files, too.
javascript=/usr/share/javascript
cp -L "$javascript/normalize.css/normalize.css" "$site/_static/styles/"
sed -i 's|@import url(/javascript/normalize.css/normalize.css)|@import url(normalize.css)|' "$site/_static/styles/furo.css"
scripts=$site/_static/scripts
if grep -q '^import Gumshoe' "$scripts/furo.js"; then
  sed '/^import Gumshoe/d' "$scripts/furo.js" | cat "$scripts/gumshoe-patched.js" - >"$scripts/whole.js"
  mv "$scripts/whole.js" "$scripts/furo.js"
fi

# Equations: the part of Debian's MathJax that a page loads, with fonts as paths.
mathjax=$javascript/mathjax
rm -rf "$site/_static/mathjax"
mkdir -p "$site/_static/mathjax"/{config,jax/output,jax/input}
cp -L "$mathjax/MathJax.js" "$site/_static/mathjax/"
cp -L "$mathjax/config/TeX-AMS_SVG.js" "$site/_static/mathjax/config/"
cp -rL "$mathjax/jax/input/TeX" "$site/_static/mathjax/jax/input/"
cp -rL "$mathjax/jax/output/SVG" "$site/_static/mathjax/jax/output/"
cp -rL "$mathjax/jax/element" "$site/_static/mathjax/jax/"
cp -rL "$mathjax/extensions" "$site/_static/mathjax/"

echo '<!doctype html><meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">Isostat</a>' \
  >"$site/index.html"
rm -rf "$output/html"
mv "$site" "$output/html"
echo "docs: $output/html/index.html"
