#!/usr/bin/env bash
# packages.sh LIST [SECTION...]: installs the Debian/Ubuntu packages of LIST (one name per line) that are not installed:
# those above the first "[section]" line, which everything needs, and those of the sections named here, without which
# less is tested. Without any missing it does nothing and needs neither root nor a network.
set -euo pipefail

list=$1
if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
    echo "packages: no Debian or Ubuntu here, nothing installed; the build needs what $list lists" >&2
    exit 0
fi

installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2> /dev/null | awk '$2 == "installed" {print $1}')
# missing SECTION: the packages of a section that are not installed; "" is what stands above all sections.
missing() {
    awk -v wanted="$1" '/^[[:space:]]*(#|$)/ {next} /^\[/ {section = substr($1, 2, length($1) - 2); next}
                        section == wanted {print $1}' "$list" | { grep -vxF -f <(echo "$installed") || true; }
}
# Not everything exists everywhere: Ubuntu has no chromium but as a snap. Without apt's lists nothing is known yet.
offered() { apt-cache show "$1" > /dev/null 2>&1 || ! compgen -G '/var/lib/apt/lists/*Packages*' > /dev/null; }
only_offered() { while read -r package; do if offered "$package"; then echo "$package"; fi; done; }

mapfile -t needed < <(missing "")
mapfile -t wished < <(for section in "${@:2}"; do missing "$section"; done | only_offered)
[ $((${#needed[@]} + ${#wished[@]})) -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
        echo "packages: neither root nor sudo: ask an administrator for: apt-get install --no-install-recommends ${needed[*]} ${wished[*]}" >&2
        [ ${#needed[@]} -gt 0 ] && exit 1
        exit 0
    fi
    # Without a terminal nobody could type a password.
    if [ -t 0 ]; then as_root=(sudo); else as_root=(sudo -n); fi
fi

# Another apt (a machine's first boot starts one) is waited for.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=120)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() {
    "$@" > "$log" 2>&1 < /dev/null && return
    tail -n 15 "$log" >&2
    echo "packages: could not install ${needed[*]} ${wished[*]} (the reason stands above)" >&2
    exit 1
}

echo "packages: installing ${needed[*]} ${wished[*]}"
quietly "${apt[@]}" update
mapfile -t wished < <(printf '%s\n' "${wished[@]}" | only_offered)
quietly "${apt[@]}" install --no-install-recommends "${needed[@]}" "${wished[@]}"
