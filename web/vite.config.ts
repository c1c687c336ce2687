import { defineConfig } from "vitest/config";

// The daemon that `npm run dev` asks. It checks where a request comes from; to it, the development
// server is a foreign origin, so what says so is left out on the way.
const daemon = process.env.BIOTOMY_URL ?? "http://127.0.0.1:8080";
const proxy = {
  target: daemon,
  changeOrigin: true,
  configure(server: { on(event: "proxyReq", listener: (request: Outgoing) => void): unknown }) {
    server.on("proxyReq", (request) => {
      request.removeHeader("origin");
      request.removeHeader("referer");
      request.removeHeader("sec-fetch-site");
    });
  },
};
interface Outgoing {
  removeHeader(name: string): void;
}

export default defineConfig({
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: {
    target: "es2021",
    manifest: true, // for check_first_view
    assetsInlineLimit: 0, // no data: addresses; each file is one the daemon can name
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    chunkSizeWarningLimit: 700,
  },
  server: {
    proxy: { "/api": proxy, "/healthz": proxy, "/metrics": proxy, "/volume.ome.zarr": proxy },
  },
  test: { include: ["test/**/*.test.{ts,tsx}"] },
});
