#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Says after an installation what is to be set so that what is installed is found; nothing if all is found.
#   tell_installed.sh BINDIR LIBDIR PYTHON-FOLDER GSTREAMER'S-PLUGIN-FOLDER [to-parent]
# With the last word, to where its parent prints.
[ -z "${DESTDIR-}${MESON_INSTALL_QUIET-}" ] || exit 0
in_prefix() { case $1 in /*) echo "$1" ;; *) echo "$MESON_INSTALL_PREFIX/$1" ;; esac; }
bin=$(in_prefix "$1") lib=$(in_prefix "$2") python=$3 searched=$4
lines=
add() { lines="$lines    export $1=$2\${$1:+:\$$1}
"; }
case :$PATH: in *":$bin:"*) ;; *) add PATH "$bin" ;; esac
[ "$(realpath -m "$lib/gstreamer-1.0")" = "$(realpath -m "$searched")" ] || add GST_PLUGIN_PATH "$lib/gstreamer-1.0"
if [ -n "$python" ] && ! /usr/bin/python3 -c 'import sys; sys.exit(sys.argv[1] not in sys.path)' "$python"; then
    add PYTHONPATH "$python"
fi
case :$(pkg-config --variable pc_path pkg-config 2>/dev/null): in *":$lib/pkgconfig:"*) ;; *) add PKG_CONFIG_PATH "$lib/pkgconfig" ;; esac
if ! /sbin/ldconfig -p 2>/dev/null | grep -q "=> $lib/libgst-spidar\.so"; then
    # A folder of the system needs no more than its list made anew.
    case " $(cat /etc/ld.so.conf.d/*.conf 2>/dev/null | tr '\n' ' ') " in
    *" $lib "*) lines="$lines    sudo ldconfig
" ;;
    *) add LD_LIBRARY_PATH "$lib" ;;
    esac
fi
[ -z "${5-}" ] || exec >>"/proc/$PPID/fd/1"
[ -z "$lines" ] || printf '\nWhat is installed is found after these lines, in a shell or in ~/.profile:\n%s' "$lines"
