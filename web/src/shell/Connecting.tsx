import { connection } from "../api/live";
import { now } from "./now";

const patience_ms = 5000;

/** While nothing has been heard yet; after a while, with what may keep the server from being heard. */
export function Connecting() {
  const { state, since } = connection.value;
  const isLong = state === "connecting" && now.value - since > patience_ms;
  return (
    <>
      Connecting…
      {isLong && " Other windows of this browser may hold all its connections: close one."}
    </>
  );
}
