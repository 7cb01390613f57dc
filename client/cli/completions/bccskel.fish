# fish completion for bccskel. A test compares it with --help.

set -l commands voxelize submit skeletonize info view generate bench
set -l shapes ball torus tubes blob horse tree knot box hollow-ball

function __bccskel_option --description 'An option of some commands: commands, then as complete'
    complete -c bccskel -n "__fish_seen_subcommand_from $argv[1]" $argv[2..-1]
end

complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -l version -d 'Print the version'
complete -c bccskel -f -s h -l help -d 'Print the options'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a voxelize -d 'Fill a mesh with bcc lattice points'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a submit -d 'Send a volume to a server for its skeleton'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a skeletonize -d 'Make a skeleton in one go'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a info -d 'Describe a mesh or a volume'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a view -d 'Make a page to look at a result'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a generate -d 'Make a test object'
complete -c bccskel -n "not __fish_seen_subcommand_from $commands" -f -a bench -d 'Measure the speed of this machine'

__bccskel_option 'voxelize submit skeletonize view generate' -r -s o -l output -d 'Output file'
__bccskel_option 'voxelize submit skeletonize info view generate bench' -f -l json -d 'Print the summary as JSON'
__bccskel_option 'voxelize submit skeletonize info view bench' -x -l threads -d 'Threads to use'
__bccskel_option 'voxelize skeletonize view generate bench' -x -l points -d 'Lattice points'
__bccskel_option 'voxelize skeletonize view' -x -l spacing -d 'Edge of the cubic cell'
__bccskel_option 'voxelize skeletonize view' -x -l fill -a 'auto parity winding' -d 'What is inside a mesh'
__bccskel_option 'submit skeletonize' -x -l server -a '127.0.0.1:50051 unix:' -d 'Where the server is'
__bccskel_option skeletonize -f -l local -d 'Compute on this machine'
__bccskel_option 'submit skeletonize' -x -l distance -a 'chamfer chamfer-optimal euclidean' -d 'How the distances that make the shells are measured'
__bccskel_option 'submit skeletonize' -x -l stubble -a 'keep-two literal none' -d 'Which stubble points to remove'
__bccskel_option 'submit skeletonize' -x -l shell-width -d 'Thickness of a shell in lattice units'
__bccskel_option 'submit skeletonize' -x -l last-shell -d 'Stop after this shell'
__bccskel_option 'submit skeletonize' -f -l no-cleanup -d 'Leave simple points'
__bccskel_option 'submit skeletonize' -x -l progress -a 'auto always never' -d 'Show the shells'
__bccskel_option 'submit skeletonize' -x -l timeout -d 'Give up after this many seconds'
__bccskel_option view -r -l object -d 'What the result was made from'
__bccskel_option generate -f -a "$shapes" -d 'Shape'
__bccskel_option generate -x -l seed -d 'Chooses the random parts'
__bccskel_option generate -x -l noise -d 'Fraction of boundary points that change sides'
__bccskel_option bench -f -a core -d 'From volume to skeleton in memory'
__bccskel_option bench -x -l shape -a 'ball torus horse blob tubes tree thin-tubes' -d 'What to thin'
__bccskel_option bench -x -l isa -d 'Instruction set'
__bccskel_option bench -x -l method -a directional -d 'How to thin'
__bccskel_option bench -x -l repeat -d 'Warm runs'
