#!/usr/bin/env bash
# Fetches the distribution's source of a package by apt-get, with separate entries and lists, so that those of the
# system do not change. Requires dpkg-dev. Arguments: package, folder. Unpacks the source in FOLDER/source.
set -euo pipefail
mkdir -p "$2"/{entries,lists/partial,cache,source}
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
    [[ ! -f $file ]] || sed 's/^deb /deb-src /; s/^Types:.*/Types: deb-src/' "$file" \
        >"$2/entries/system-${file##*/}"
done
apt=(apt-get -q -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$2/entries"
    -o "Dir::State::lists=$2/lists" -o "Dir::Cache=$2/cache")
"${apt[@]}" update || true # other archives may have no sources
cd "$2/source"
"${apt[@]}" source "$1"
