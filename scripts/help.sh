# For other scripts, after `set -eu`: asked for --help, prints the comment at the script's head. `. "$(dirname "$0")/help.sh"`
case " $* " in *" --help "* | *" -h "*) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
