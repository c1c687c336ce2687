import { Button } from "../ui/Button";
import { fixed } from "../ui/numbers";
import { speeds } from "./series_player";
import type { SeriesPlayer } from "./series_player";

interface Props {
  player: SeriesPlayer;
}

/** Plays the series that is chosen; the frames can be looked at one by one. */
export function PlayerBar({ player }: Props) {
  const frames = player.frames.value;
  const current = player.current.value;
  const open = frames.length > 0;
  const turns = player.choice.value.kind === "rotate";
  const words = current ? `${fixed(current.value, 1)}${turns ? "°" : "\u00a0µm"}` : "";
  return (
    <div class="player-bar" role="group" aria-label="Player">
      {player.playing.value ? (
        <Button onClick={() => player.pause()}>Pause</Button>
      ) : (
        <Button onClick={() => void player.play()}>Play series</Button>
      )}
      {open && (
        <>
          <input
            type="range"
            class="player-scrub"
            aria-label="Frame of the series"
            aria-valuetext={words}
            min={0}
            max={frames.length - 1}
            step={1}
            value={player.index.value}
            onInput={(event) => void player.scrub(event.currentTarget.valueAsNumber)}
          />
          <span class="player-label">{words}</span>
          <label class="player-speed">
            <span class="visually-hidden">Speed</span>
            <select
              value={player.speed.value}
              onChange={(event) => (player.speed.value = Number(event.currentTarget.value))}
            >
              {speeds.map((speed) => (
                <option key={speed} value={speed}>
                  {speed} per s
                </option>
              ))}
            </select>
          </label>
          <Button onClick={() => player.cutHere()}>Cut here</Button>
          <Button onClick={() => player.close()}>Back</Button>
        </>
      )}
      {player.failure.value && <span class="bad">{player.failure.value}</span>}
    </div>
  );
}
