# Makes bccskel.1 of bccskel.1.in: a line "@COMMAND" becomes the section of that command, from its
# --help; `words` and --options become bold.
# usage: awk -v program=build/.../bccskel -f man_page.awk bccskel.1.in

function styled(text,    word, done) {
  while (match(text, /`[^`]*`|--[a-z][a-z-]*/)) {
    word = substr(text, RSTART, RLENGTH)
    gsub(/`/, "", word)
    gsub(/-/, "\\-", word)
    done = done substr(text, 1, RSTART - 1) "\\fB" word "\\fR"
    text = substr(text, RSTART + RLENGTH)
  }
  return done text
}

# An option with the same text is described once, in the first section that has it.
function print_option(command, entry, text,    names, end) {
  sub(/ Excludes:.*/, "", entry)
  sub(/^--isa .*/, "--isa NAME", entry)  # whose help lists what the building machine supports
  end = index(entry " ", " ")
  names = substr(entry, 1, end - 1)
  if (entry == "" || names == "-h,--help") return
  gsub(/,/, ", ", names)
  if (names ~ /^-/ && (entry text) in told) {
    others[told[entry text]] = others[told[entry text]] ", " names
    return
  }
  told[entry text] = command
  printf ".TP\n%s%s\n%s\n", styled("`" names "`"), substr(entry, end), styled(text)
}

function print_command(command,    help, line, entry, text, number, first) {
  help = program " " command " --help"
  while ((help | getline line) > 0 && line !~ /^Exit codes/) {
    number++
    if (number == 1) first = line "."
    if (number == 2) {
      sub(/^Usage: /, "", line)
      sub(/ \[OPTIONS\]/, "", line)
      printf ".SS %s\n%s\n", line, first
    }
    if (number <= 2 || line ~ /^ *(Options:|Positionals:|\[Option Group.*)?$/) continue
    if (line ~ /^                    /) {
      sub(/^ +/, "", line)
      text = text (text == "" ? "" : "\n.br\n") line
    } else if (line ~ /^ +-|^ +[A-Z].*  /) {
      print_option(command, entry, text)
      sub(/^ +/, "", line)
      sub(/\(required\) /, "&  ", line)
      entry = line
      text = ""
      if (match(line, /  +/)) {
        entry = substr(line, 1, RSTART - 1)
        text = substr(line, RSTART + RLENGTH)
      }
    }
  }
  while ((help | getline line) > 0) continue
  if (close(help) != 0 || number < 4) exit 1
  print_option(command, entry, text)
  for (number = 1; number <= count; number++) {
    if (!(commands[number] in others)) continue
    print ".PP\n" styled("As for `" commands[number] "`: " substr(others[commands[number]], 3) ".")
    delete others[commands[number]]
  }
  commands[++count] = command
}

/^@/ { print_command(substr($0, 2)); next }
{ print styled($0) }
