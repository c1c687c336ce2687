export function LayersView() {
  return (
    <main id="main" class="view" data-view="layers" tabIndex={-1}>
      <h1>Layers</h1>
    </main>
  );
}
