# fish completion for bccskel, which says itself what may follow.

function __bccskel_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l lines ($words[1] __complete $words[2..-1] 2> /dev/null)
    if test "$lines[1]" = :files
        __fish_complete_path (commandline -ct)
    else
        printf '%s\n' $lines
    end
end
complete -c bccskel -f -a '(__bccskel_complete)'
