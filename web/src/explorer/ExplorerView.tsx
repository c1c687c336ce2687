export function ExplorerView() {
  return (
    <main id="main" class="view" data-view="explorer" tabIndex={-1}>
      <h1>Explorer</h1>
    </main>
  );
}
