# For other scripts: figures of an `evit run`, out of its report.json. `. scripts/report.sh`
field() { sed -n "s/.*\"$2\": \\([0-9.e+-]*\\),*/\\1/p" "$1" | head -1; }  # file, name: a number
mode() { sed -n 's/.*"final_mode": "\(.*\)".*/\1/p' "$1"; }  # file: at the end
# Normalised squared error by degree of freedom. File, part of the pose: position, orientation or pose.
nees() { awk -v p="\"$2_nees\"" 'index($0, p) {on = 1} on && /mean_per_dof/ {gsub(/.*: |,/, ""); print; exit}' "$1"; }
