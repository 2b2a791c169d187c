#!/usr/bin/env bash
# Starts a private PostgreSQL server on loopback for tests: not a system service, without passwords, with all files in one
# folder. Needs Debian's `postgresql` (or `initdb` and `pg_ctl` in PATH).
#
#     scripts/postgres.sh start FOLDER [PORT [ADDRESS [NETWORK]]]   prints the URL for --db
#     scripts/postgres.sh stop FOLDER                               stops the server and removes the folder
#
# Without PORT, a free port is used. The server also listens on ADDRESS, and accepts clients from NETWORK (as 10.0.0.0/8).
#
# The server syncs and encrypts like a production server, so that measurements are realistic. TRIBOSWEEP_POSTGRES_FSYNC=off
# makes tests faster. Without `openssl`, the server does not encrypt.
set -euo pipefail

usage() {
    sed -n '2,11s/^# \{0,1\}//p' "$0" >&2
    exit 2
}

find_tool() {
    command -v "$1" || ls -d /usr/lib/postgresql/*/bin/"$1" 2> /dev/null | sort -V | tail -1 | grep . || {
        echo "no $1: install PostgreSQL (Debian: apt-get install postgresql)" >&2
        exit 3
    }
}

# PostgreSQL refuses to run as root; Debian's package creates a user for it.
as_owner() {
    if [ "$(id -u)" = 0 ]; then setpriv --reuid postgres --regid postgres --init-groups -- "$@"; else "$@"; fi
}

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# Creates a self-signed certificate, which `sslrootcert` can name.
certificate() {
    command -v openssl > /dev/null || return 0
    as_owner openssl req -x509 -days 3650 -nodes -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 \
        -keyout data/server.key -out data/server.crt -config - 2> openssl.log << 'END' || return 0
[req]
distinguished_name = name
x509_extensions = extensions
prompt = no
[name]
CN = localhost
[extensions]
subjectAltName = DNS:localhost, IP:127.0.0.1
basicConstraints = critical, CA:FALSE
END
    echo "ssl = on" >> data/postgresql.conf
}

start() {
    local folder=$1 port=${2:-$(free_port)} address=${3:-} network=${4:-}
    local initdb pg_ctl
    initdb=$(find_tool initdb)
    pg_ctl=$(find_tool pg_ctl)
    mkdir -p "$folder"
    folder=$(cd "$folder" && pwd)
    [ -z "$(ls -A "$folder")" ] || { echo "$folder is not empty" >&2; exit 2; }
    [ "$(id -u)" != 0 ] || chown postgres "$folder"
    cd "$folder"
    as_owner "$initdb" --pgdata data --username tribosweep --auth trust --encoding UTF8 --locale C > initdb.log
    {
        echo "port = $port"
        echo "listen_addresses = '127.0.0.1${address:+,$address}'"
        echo "unix_socket_directories = ''"
        echo "max_connections = 200"
        echo "fsync = ${TRIBOSWEEP_POSTGRES_FSYNC:-on}"
    } >> data/postgresql.conf
    certificate
    [ -z "$network" ] || echo "host all all $network trust" >> data/pg_hba.conf
    if ! as_owner "$pg_ctl" --pgdata data --log server.log --wait start > pg_ctl.log; then
        cat pg_ctl.log server.log >&2
        exit 3
    fi
    echo "postgres://tribosweep@127.0.0.1:$port/postgres"
}

stop() {
    local folder=$1
    [ -d "$folder/data" ] || { echo "there is no PostgreSQL in $folder" >&2; exit 2; }
    as_owner "$(find_tool pg_ctl)" --pgdata "$folder/data" --mode fast --wait stop > /dev/null || true
    rm -r "$folder"
}

case "${1:-}" in
    start) [ $# -ge 2 ] || usage; shift; start "$@" ;;
    stop) [ $# -eq 2 ] || usage; stop "$2" ;;
    *) usage ;;
esac
