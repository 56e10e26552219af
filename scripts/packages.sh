#!/usr/bin/env bash
# packages.sh LIST: installs the Debian/Ubuntu packages of LIST (one name per line) that are not installed.
# Without any missing it does nothing and needs neither root nor a network.
set -euo pipefail

mapfile -t wanted < <(grep -Ev '^[[:space:]]*(#|$)' "$1")
if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
    echo "packages: no Debian or Ubuntu here, nothing installed; the build needs what $1 lists" >&2
    exit 0
fi

installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2> /dev/null | awk '$2 == "installed" {print $1}')
missing=()
for package in "${wanted[@]}"; do
    grep -qxF -- "$package" <<< "$installed" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
        echo "packages: neither root nor sudo: ask an administrator for: apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    # Without a terminal nobody could type a password.
    if [ -t 0 ]; then as_root=(sudo); else as_root=(sudo -n); fi
fi

# Another apt (a machine's first boot starts one) is waited for.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=120)
echo "packages: installing ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${apt[@]}" update && "${apt[@]}" install --no-install-recommends "${missing[@]}"; } > "$log" 2>&1 < /dev/null; then
    tail -n 15 "$log" >&2
    echo "packages: could not install ${missing[*]} (the reason stands above)" >&2
    exit 1
fi
