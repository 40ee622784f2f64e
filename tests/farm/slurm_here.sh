# SPDX-License-Identifier: Apache-2.0
# Slurm of one machine, for tests: sourced by slurm.sh. Needs root. All it writes lies in $services,
# and each service is ended by its own process id.
#
#   install_slurm    installs Debian's slurm-wlm and munge, unless they are there
#   start_slurm      starts munged, slurmctld and slurmd, and waits until the node is ready
#   start_slurmd, kill_slurmd
#   stop_slurm       ends what was started

has_slurm() {
    local program
    for program in munged slurmctld slurmd sbatch; do
        command -v $program >/dev/null || return 1
    done
}

install_slurm() {
    has_slurm && return
    apt-get update -q
    # Packages start their services, which are not needed here.
    DEBIAN_FRONTEND=noninteractive RUNLEVEL=1 \
        apt-get install -q -y --no-install-recommends slurm-wlm munge
}

# await SECONDS COMMAND...: until the command succeeds.
await() {
    local seconds=$1 end
    shift
    end=$((SECONDS + seconds))
    until "$@"; do
        if ((SECONDS > end)); then
            echo "waited $seconds s in vain for: $*" >&2
            return 1
        fi
        sleep 0.5
    done
}

node_is() { [[ $(sinfo -h -o %T -n "$(hostname -s)" | head -1) == $1 ]]; }

write_slurm_conf() {
    local host
    host=$(hostname -s)
    cat >"$SLURM_CONF" <<CONF
ClusterName=woodcock
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$((20000 + 2 * ($$ % 10000)))
SlurmdPort=$((20001 + 2 * ($$ % 10000)))
AuthType=auth/munge
AuthInfo=socket=$services/munge.socket
CredType=cred/munge
SlurmUser=root
StateSaveLocation=$services/state
SlurmdSpoolDir=$services/spool
SlurmctldPidFile=$services/slurmctld.pid
SlurmdPidFile=$services/slurmd.pid
SlurmctldLogFile=$services/slurmctld.log
SlurmdLogFile=$services/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/filetxt
JobCompLoc=$services/completed
ReturnToService=2
SlurmdTimeout=10
KillWait=10
MinJobAge=600
SlurmdParameters=config_overrides
SlurmctldParameters=preempt_send_user_signal
SchedulerParameters=bf_interval=3,sched_interval=5
MaxArraySize=1001
MaxJobCount=${max_jobs:-1000}
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 Boards=1 SocketsPerBoard=1 CoresPerSocket=4 ThreadsPerCore=1 RealMemory=1000 State=UNKNOWN
PartitionName=low Nodes=ALL Default=YES MaxTime=INFINITE State=UP PriorityTier=1 GraceTime=60
PartitionName=high Nodes=ALL MaxTime=INFINITE State=UP PriorityTier=10 PreemptMode=OFF
CONF
}

start_slurmd() {
    slurmd -D -c >"$services/slurmd.out" 2>&1 &
    slurmd=$!
}

kill_slurmd() {
    kill -9 "$slurmd"
    wait "$slurmd" 2>/dev/null || true
}

start_slurm() {
    mkdir -p "$services"/{state,spool}
    export SLURM_CONF=$services/slurm.conf
    write_slurm_conf
    head -c 1024 /dev/urandom >"$services/munge.key"
    chmod 600 "$services/munge.key"
    munged --foreground --force --key-file="$services/munge.key" \
        --socket="$services/munge.socket" --pid-file="$services/munged.pid" \
        --log-file="$services/munged.log" --seed-file="$services/munged.seed" \
        >"$services/munged.out" 2>&1 &
    munged=$!
    await 60 test -S "$services/munge.socket"
    slurmctld -D -c >"$services/slurmctld.out" 2>&1 &
    slurmctld=$!
    start_slurmd
    await 120 node_is idle
}

stop_slurm() {
    local service
    for service in ${slurmd:-} ${slurmctld:-} ${munged:-}; do
        kill "$service" 2>/dev/null || continue
        wait "$service" 2>/dev/null || true
    done
}
